// ctest labels: unit
// Which passes an image is made of, and how a list of them is run.
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// Writes down when it begins and is run.
class NotingPass final : public Pass {
  public:
    NotingPass(std::vector<std::string>& notes, Stage stage, Of of = Of::light)
        : Pass(stage, of), notes_(notes) {}
    void begin(Rendering& /*rendering*/) override { note("begin "); }
    void run(Rendering& /*rendering*/) override { note("run "); }

  private:
    void note(std::string what) { notes_.push_back(what.append(name_of(*stage()))); }

    std::vector<std::string>& notes_;
};

class Passes : public testing::Test {
  protected:
    Passes() {
        desc_.geometry = {plane_at_z(4)};
        desc_.lamps = {isotropic_lamp({-0.5, 0, 0}, 10)};
        desc_.render.samples.reset();  // more than one
    }

    ImageScene image() const { return {SceneDesc(desc_), choice_}; }
    LayerSet provided() const { return make_passes(image()).supply().layers; }
    PassNeeds needs(const char* layers = "depth") const {
        return make_passes(image()).needs(layer_plan(image(), layers));
    }

    SceneDesc desc_ = pinhole_scene(8, 6);
    ImageChoice choice_;
};

TEST_F(Passes, AllBeginBeforeTheFirstOfTheirKindIsRun) {
    Renderer renderer;
    renderer.set_scene(image());
    const LightTransport transport = renderer.make_transport();
    const LayerPlan plan = layer_plan(image(), "depth");
    const BandColour colour(desc_.water.bands_nm);
    Film film(8, 6, {0, 0, 8, 6}, plan.channel_names());
    std::vector<std::string> notes;
    std::atomic<bool> stop = false;
    const StageProgressCallback progress = [&](Stage stage, double fraction) {
        EXPECT_EQ(fraction, 0);
        notes.push_back("stage " + std::string(name_of(stage)));
    };
    ImageProgress reached;
    Rendering rendering = make_rendering(renderer.assembled(), *renderer.assembled().camera,
                                         transport, {}, {plan, colour, film, progress, reached});
    PassList passes;
    passes.add<NotingPass>(notes, Stage::snow);
    passes.add<NotingPass>(notes, Stage::reflection, Pass::Of::truth);
    passes.add<NotingPass>(notes, Stage::render);
    passes.run(Pass::Of::light, rendering);
    EXPECT_EQ(notes, (std::vector<std::string>{"begin snow", "begin render", "stage snow",
                                               "run snow", "stage render", "run render"}));
    notes.clear();
    stop = true;
    const StopScope scope(stop);
    EXPECT_THROW(passes.run(Pass::Of::truth, rendering), Interrupted);
    EXPECT_EQ(notes, (std::vector<std::string>{"begin reflection", "stage reflection"}));
}

TEST_F(Passes, NeedAndProvideWhatTheSceneAsksFor) {
    EXPECT_TRUE(needs().light);
    EXPECT_FALSE(needs().slabs || needs().paths || needs().whole_image);
    EXPECT_TRUE(needs("backscatter_first").slabs);
    for (const LayerKind& kind : k_layers) EXPECT_FALSE(provided().has(kind.layer)) << kind.name;

    desc_.water.forward_scatter.K = 0.5;
    EXPECT_TRUE(needs().slabs && needs().whole_image);
    EXPECT_TRUE(provided().has(Layer::forward));
    desc_.water.forward_scatter.K = 0;

    desc_.render.scattering = RenderDesc::Scattering::multiple;
    EXPECT_TRUE(needs().light && needs().paths);
    EXPECT_TRUE(provided().has(Layer::multiple_surface));
    EXPECT_TRUE(provided().has(Layer::error));

    desc_.render.integrator = RenderDesc::Integrator::path;
    EXPECT_TRUE(needs().paths);
    EXPECT_FALSE(needs().light);
    EXPECT_TRUE(provided().has(Layer::multiple_surface));
    EXPECT_TRUE(provided().has(Layer::error));
    EXPECT_EQ(make_passes(image(), {.orders = 3}).supply().orders, 3);
    desc_.render.samples = 1;
    EXPECT_FALSE(provided().has(Layer::error));
}

// A layer that is not in every image has a pass that provides it, and no other has.
TEST_F(Passes, ProvideEveryLayerThatHasToBeProvided) {
    desc_.render.scattering = RenderDesc::Scattering::multiple;
    desc_.water.snow.emplace();
    desc_.camera.sensor.emplace();
    choice_.frame = 1;
    desc_.cameras.assign(2, {"", desc_.camera});
    VolumeDesc& plume = desc_.volumes.emplace_back();
    plume.grids.emplace_back();
    plume.motion.emplace();
    LayerSet all = provided();
    desc_.render.integrator = RenderDesc::Integrator::path;
    all |= provided();
    for (const LayerKind& kind : k_layers)
        EXPECT_EQ(all.has(kind.layer), !kind.hint.empty()) << kind.name;
}

}  // namespace
}  // namespace uw::test
