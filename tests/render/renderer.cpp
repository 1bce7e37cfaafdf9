// ctest labels: unit metamorphic
#include "render/renderer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>

#include "core/base/error.h"
#include "core/light/reference_integrator.h"
#include "tests/support/field_maker.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// A box before a wall, two lamps that stand in the world, and a small cloud.
class Images : public testing::Test {
  protected:
    Images() {
        desc_ = pinhole_scene(20, 14);
        desc_.geometry = {plane_at_z(4), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
        desc_.lamps = {isotropic_lamp({-0.5, -0.2, 0}, 40), isotropic_lamp({0.6, 0.3, 0.1}, 30)};
        desc_.lamps[1].name = "second";
        for (LampDesc& lamp : desc_.lamps) lamp.fixed_to_camera = false;
        VdbFixture fixture = bumpy_fixture();
        fixture.file_from_index = Affine::translation({0, 0, 2}) * Affine::scale(Vector3(0.05));
        desc_.volumes = {maker_.volume(fixture)};
        desc_.volumes[0].grids[0].optics =
            GridMappingDesc::Optics{{0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {}};
    }

    /// The image of the scene as it is now, by `renderer` and by a new one: to the bit.
    void expect_as_new(Renderer& renderer, const RenderOptions& options = {.layers = "all"}) {
        renderer.set_scene(SceneDesc(desc_));
        const Film& film = renderer.render(options);
        Renderer fresh;
        fresh.set_scene(SceneDesc(desc_));
        const Film& expected = fresh.render(options);
        EXPECT_EQ(film.window(), expected.window());
        EXPECT_EQ(film.channel_names(), expected.channel_names());
        EXPECT_TRUE(std::ranges::equal(film.values(), expected.values()));
        EXPECT_EQ(renderer.report().warnings, fresh.report().warnings);
        EXPECT_GT(*std::ranges::max_element(film.values()), 0);
    }

    FieldMaker maker_;
    SceneDesc desc_;
};

TEST_F(Images, OfOneRendererAreToTheBitThoseOfNewOnes) {
    Renderer renderer;
    const auto change = [&](const char* what, const std::function<void()>& edit,
                            const RenderOptions& options = {.layers = "all"}) {
        SCOPED_TRACE(what);
        edit();
        expect_as_new(renderer, options);
    };
    change("first", [] {});
    change("nothing", [] {});
    change("camera", [&] { desc_.camera.world_from_camera = Affine::translation({0.1, 0, -0.2}); });
    change("lamp", [&] { desc_.lamps[1].position.y += 0.1; });
    change("lamp less", [&] { desc_.lamps.pop_back(); });
    change("water", [&] { desc_.water.absorption = PerBand{0.1, 0.2, 0.3}; });
    change("surfaces", [&] { desc_.geometry[1].min.x -= 0.1; });
    change("reference", [&] { desc_.render.integrator = RenderDesc::Integrator::reference; });
    change("volume", [&] { desc_.render.integrator = RenderDesc::Integrator::volume; });
    change("draft", [&] { desc_.render.quality = RenderDesc::Quality::draft; });
    change("final", [&] { desc_.render.quality = RenderDesc::Quality::final; });
    change("size", [&] {
        desc_.camera.width = 16;
        desc_.camera.intrinsics.cx = 8;
    });
    change("window", [] {}, {.layers = "depth", .window = PixelWindow{3, 2, 9, 7}});
    change("forward scatter",
           [&] { desc_.water.forward_scatter = {.K = 1, .G = 0.02, .B = 0.05}; });
    change("colour", [&] { desc_.render.colour.response = ColourDesc::Response::cie; });
    change("no volume", [&] { desc_.volumes.clear(); });
    change("planes", [&] { desc_.render.integrator = RenderDesc::Integrator::planes; });
}

TEST_F(Images, OfTheSameSceneAreTheSameAndNeedNoMoreLight) {
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc_));
    const Film first = renderer.render();
    EXPECT_GT(renderer.report().splat_rays, 0U);
    const Film& second = renderer.render();
    EXPECT_EQ(renderer.report().splat_rays, 0U);
    EXPECT_TRUE(std::ranges::equal(first.values(), second.values()));
    const float* const memory = second.values().data();
    EXPECT_EQ(renderer.render().values().data(), memory);  // used again
    renderer.drop_light();
    EXPECT_TRUE(std::ranges::equal(renderer.render().values(), first.values()));
    EXPECT_GT(renderer.report().splat_rays, 0U);
}

TEST_F(Images, AWindowWithForwardScatterIsCutFromTheWholeImage) {
    desc_.water.forward_scatter = {.K = 1, .G = 0.02, .B = 0.05};
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc_));
    const Film whole = renderer.render();
    const PixelWindow window{3, 2, 9, 7};
    const Film& part = renderer.render({.window = window});
    EXPECT_EQ(renderer.report().pixels, 20U * 14U);
    ASSERT_EQ(part.window(), window);
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            EXPECT_TRUE(std::ranges::equal(part.pixel(x, y), whole.pixel(x, y)));
}

TEST_F(Images, ReportWhatTheyWereMadeOf) {
    desc_.render.samples = 4;
    desc_.lamps[0].position = {0, 0, 0};  // where the camera is: warned of
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc_));
    renderer.prepare({.window = PixelWindow{0, 0, 5, 4}});
    ASSERT_EQ(renderer.report().warnings.size(), 1U);
    EXPECT_NE(renderer.report().warnings[0].find("the lamp is where"), std::string::npos);
    renderer.render({.window = PixelWindow{0, 0, 5, 4}});
    const RenderReport& report = renderer.report();
    EXPECT_EQ(report.warnings.size(), 1U);
    EXPECT_EQ(report.pixels, 20U);
    EXPECT_EQ(report.camera_rays, 100U);  // four samples and the pixel's centre
    EXPECT_EQ(report.lamps, 2U);
    EXPECT_EQ(report.bands, 3U);
    EXPECT_EQ(report.triangles, renderer.assembled().surfaces->triangle_count());
    EXPECT_EQ(report.active_voxels,
              static_cast<std::uint64_t>(
                  renderer.assembled().volume_reports.at(0).statistics.active_voxels));
    EXPECT_GT(report.grid_bytes, 0U);
    EXPECT_GT(report.light_bytes, 0U);
}

TEST_F(Images, CanBeCancelledInEveryStageAndAskedForAgain) {
    desc_.water.forward_scatter = {.K = 1, .G = 0.02, .B = 0.05};
    Renderer plain;
    plain.set_scene(SceneDesc(desc_));
    const Film expected = plain.render();
    for (const Stage stop :
         {Stage::volumes, Stage::geometry, Stage::splat, Stage::render, Stage::forward_scatter}) {
        bool asked = false;
        std::atomic<bool> flag = false;
        const StopScope scope(flag);
        Renderer renderer([&](Stage stage, double) {
            if (asked && stage == stop) flag = true;
        });
        const auto expect_stopped = [&] {
            asked = true;
            EXPECT_THROW(renderer.render(), Interrupted) << name_of(stop);
            asked = flag = false;
        };
        renderer.set_scene(SceneDesc(desc_));
        expect_stopped();
        EXPECT_TRUE(std::ranges::equal(renderer.render().values(), expected.values()))
            << name_of(stop);
        // And a scene that takes over what there was when it was cancelled.
        renderer.set_scene(SceneDesc(desc_));
        expect_stopped();
        expect_as_new(renderer);
    }
}

TEST_F(Images, TellTheirStagesInOrderFromZeroToOne) {
    desc_.water.forward_scatter = {.K = 1, .G = 0.02, .B = 0.05};
    std::mutex mutex;
    std::vector<Stage> stages;
    double reached = 0;
    Renderer renderer([&](Stage stage, double fraction) {
        const std::lock_guard lock(mutex);
        if (stages.empty() || stages.back() != stage) {
            EXPECT_EQ(fraction, 0) << name_of(stage);
            stages.push_back(stage);
        }
        EXPECT_GE(fraction, 0);
        EXPECT_LE(fraction, 1);
        reached = fraction;
    });
    renderer.set_scene(SceneDesc(desc_));
    EXPECT_TRUE(stages.empty());  // nothing is loaded by that
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    renderer.render();
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    EXPECT_EQ(stages, (std::vector{Stage::volumes, Stage::geometry, Stage::splat, Stage::render,
                                   Stage::forward_scatter}));
    EXPECT_EQ(reached, 1);

    desc_.water.forward_scatter = {};
    desc_.render.scattering = RenderDesc::Scattering::multiple;
    desc_.render.quality = RenderDesc::Quality::draft;
    stages.clear();
    renderer.set_scene(SceneDesc(desc_));
    renderer.render();
    EXPECT_EQ(std::vector(stages.end() - 2, stages.end()),
              (std::vector{Stage::multiple_scattering, Stage::render}));
    EXPECT_EQ(reached, 1);
    EXPECT_GT(renderer.report().multiple_error, 0);
    EXPECT_FALSE(renderer.report().paths.error);
}

TEST_F(Images, ThatCannotBeLeaveTheRendererAsItWas) {
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc_));
    const Film expected = renderer.render();
    for (const PixelWindow& window :
         {PixelWindow{0, 0, 21, 14}, PixelWindow{-1, 0, 4, 4}, PixelWindow{4, 4, 4, 8}})
        EXPECT_THROW(renderer.render({.window = window}), UsageError);
    EXPECT_THROW(renderer.render({.layers = "colour"}), UsageError);
    SceneDesc broken = desc_;
    broken.volumes[0].grids[0].grid = "none";
    renderer.set_scene(std::move(broken));
    EXPECT_THROW(renderer.render(), InputError);
    renderer.set_scene(SceneDesc(desc_));
    EXPECT_TRUE(std::ranges::equal(renderer.render().values(), expected.values()));
    SceneDesc open = desc_;
    open.volumes[0].is_sequence = true;
    EXPECT_THROW(renderer.set_scene(std::move(open)), InputError);
}

TEST_F(Images, TakeAnotherLightTransportOnTrial) {
    Renderer renderer;
    desc_.render.quality = RenderDesc::Quality::exact;
    renderer.set_scene(SceneDesc(desc_));
    const LitScene lit = renderer.assemble().lit();
    const LightTransport reference{std::make_unique<ReferenceIntegrator>(lit),
                                   std::make_unique<DirectLighting>(lit)};
    const Film tried = renderer.render({.layers = "direct", .transport = &reference});
    desc_.render.integrator = RenderDesc::Integrator::reference;
    renderer.set_scene(SceneDesc(desc_));
    EXPECT_TRUE(std::ranges::equal(renderer.render({.layers = "direct"}).values(), tried.values()));
}

TEST_F(Images, HaveSlabsOnlyIfTheyNeedThem) {
    Renderer renderer;
    const auto has_slabs = [&](const char* layers) {
        renderer.set_scene(SceneDesc(desc_));
        renderer.render({.layers = layers});
        return renderer.assembled().slabs.has_value();
    };
    EXPECT_FALSE(has_slabs("backscatter,depth"));
    EXPECT_TRUE(has_slabs("backscatter_first"));
    EXPECT_FALSE(has_slabs("depth"));
    desc_.render.planes.near = 1;
    EXPECT_TRUE(has_slabs("depth"));
    desc_.render.planes.near = 10;  // behind the wall
    EXPECT_THROW(has_slabs("depth"), InputError);
    desc_.render.planes = {};
    desc_.water.forward_scatter = {.K = 1, .G = 0.02, .B = 0.02};
    EXPECT_TRUE(has_slabs("depth"));
    desc_.water.forward_scatter = {};
    desc_.render.integrator = RenderDesc::Integrator::planes;
    desc_.volumes.clear();
    EXPECT_TRUE(has_slabs("depth"));
    renderer.set_scene(SceneDesc(desc_));
    EXPECT_TRUE(renderer.assemble().slabs);
}

TEST_F(Images, OfAnAssembledSceneWithAnotherPartAreNotTakenOver) {
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc_));
    const Film before = renderer.render();
    AssembledScene other = renderer.assembled();
    other.water.medium.uniform.absorption[0] = 3;
    other.scattering = nullptr;
    renderer.set_scene(std::move(other));
    const Film changed = renderer.render();
    EXPECT_FALSE(std::ranges::equal(changed.values(), before.values()));
    expect_as_new(renderer);
}

}  // namespace
}  // namespace uw::test
