// ctest labels: unit
// What each integrator that users can name states of itself.
#include "core/light/integrator_table.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/planes_scene.h"

namespace uw::test {
namespace {

using Kind = RenderDesc::Integrator;

TEST(IntegratorTable, EveryNameHasAnIntegratorThatCanBeMade) {
    for (const auto& [name, integrator] : k_integrator_names) {
        const IntegratorKind& kind = integrator_kind(integrator);
        ASSERT_NE(kind.make, nullptr) << name;
        ASSERT_NE(kind.check, nullptr) << name;
        SceneDesc desc = uniform_scene({0.5, 0, 0.5});
        desc.render.integrator = integrator;
        EXPECT_NO_THROW(kind.check(desc)) << name;
        const TestScene scene(desc);
        EXPECT_GT(scene.pixel(4, 4).backscatter[1], 0) << name;
    }
}

TEST(IntegratorTable, PlanesRefuseWaterThatVariesAndViewsAroundThem) {
    SceneDesc fisheye = pinhole_scene(8, 8);
    fisheye.camera.distortion.model = DistortionDesc::Model::fisheye;
    SceneDesc volume = pinhole_scene(8, 8);
    volume.volumes.resize(1);
    for (const SceneDesc& desc : {fisheye, volume}) {
        EXPECT_THROW(integrator_kind(Kind::planes).check(desc), InputError);
        EXPECT_NO_THROW(integrator_kind(Kind::volume).check(desc));
        EXPECT_NO_THROW(integrator_kind(Kind::reference).check(desc));
    }
}

TEST(IntegratorTable, PathRendersAllLightAndTheOthersWhatIsRequested) {
    using Scattering = RenderDesc::Scattering;
    for (const auto& [name, integrator] : k_integrator_names) {
        RenderDesc render;
        render.integrator = integrator;
        const bool paths = integrator == Kind::path;
        EXPECT_EQ(scattering_of(render), paths ? Scattering::multiple : Scattering::single) << name;
        EXPECT_EQ(samples_of(render), paths ? 16 : 4) << name;
        render.samples = 7;
        EXPECT_EQ(samples_of(render), 7) << name;
        for (const Scattering scattering : {Scattering::single, Scattering::multiple}) {
            render.scattering = scattering;
            EXPECT_EQ(scattering_of(render), scattering) << name;
        }
    }
}

TEST(IntegratorTable, ScenesOfVersion2HaveAllLightByTheIntegratorsThatRenderIt) {
    using Scattering = RenderDesc::Scattering;
    RenderDesc render;
    render.default_scattering = Scattering::multiple;
    for (const auto& [name, integrator] : k_integrator_names) {
        render.integrator = integrator;
        const bool renders_all = integrator == Kind::path || integrator == Kind::volume;
        EXPECT_EQ(scattering_of(render), renders_all ? Scattering::multiple : Scattering::single)
            << name;
    }
}

/// The message of the refusal to render a scene; empty if there is none.
std::string refusal(const SceneDesc& desc) {
    try {
        check_integrator(desc);
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

TEST(IntegratorTable, RefusesToLeaveOutOrAddLight) {
    SceneDesc desc = pinhole_scene(8, 8);
    desc.render.scattering_where = "x.yaml:1:2: render.scattering";
    desc.render.integrator = Kind::path;
    EXPECT_EQ(refusal(desc), "");
    desc.render.scattering = RenderDesc::Scattering::single;
    EXPECT_EQ(refusal(desc),
              "x.yaml:1:2: render.scattering: the integrator path always renders all light; write "
              "multiple, or leave it out; for single scattering use integrator volume");
    desc.render.scattering = RenderDesc::Scattering::multiple;
    EXPECT_EQ(refusal(desc), "");
    for (const Kind integrator : {Kind::planes, Kind::reference}) {
        desc.render.integrator = integrator;
        EXPECT_TRUE(refusal(desc).starts_with("x.yaml:1:2: render.scattering: this integrator"));
        EXPECT_NE(refusal(desc).find("use integrator volume or path"), std::string::npos);
    }
}

TEST(IntegratorTable, AllLightLeavesNothingToABlurAndThePapersFormula) {
    SceneDesc blurred = pinhole_scene(8, 8);
    blurred.water.forward_scatter = {.K = 1, .G = 0.02, .B = 0.05, .where = "x.yaml:3:4: K"};
    EXPECT_EQ(refusal(blurred), "");
    blurred.render.integrator = Kind::path;
    EXPECT_TRUE(refusal(blurred).starts_with("x.yaml:3:4: K: its blur stands for light"));
    SceneDesc paper = pinhole_scene(8, 8);
    paper.render.output = RenderDesc::Output::paper;
    paper.render.output_where = "x.yaml:5:6: render.output";
    EXPECT_EQ(refusal(paper), "");
    paper.render.integrator = Kind::path;
    EXPECT_TRUE(refusal(paper).starts_with("x.yaml:5:6: render.output: the paper's formula"));
    paper.render.output = RenderDesc::Output::sensor_irradiance;
    EXPECT_EQ(refusal(paper), "");
}

}  // namespace
}  // namespace uw::test
