// ctest labels: unit
#include "render/scene_assembly.h"

#include <gtest/gtest.h>

#include "render/renderer.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// A lamp behind the camera, in water in which its light is attenuated by 2, 1 and 3 per metre.
class FarLamps : public testing::Test {
  protected:
    FarLamps() {
        desc_ = pinhole_scene(20, 14);
        desc_.geometry.clear();
        desc_.water.absorption = PerBand{1.5, 0.5, 2.5};
        desc_.water.scattering = ScatteringDesc{{0.5, 0.5, 0.5}, {}};
        desc_.water.scattering->phase.function = HenyeyGreensteinDesc{0.8};
        desc_.lamps = {isotropic_lamp({0, 0, -7}, 40)};
        desc_.render.scattering = RenderDesc::Scattering::multiple;
    }
    const AssembledScene& scene() {
        renderer_.set_scene(SceneDesc(desc_));
        return renderer_.assemble();
    }

    SceneDesc desc_;
    Renderer renderer_;
};

TEST_F(FarLamps, AreMeasuredInTheClearestBandThatTheyShineIn) {
    EXPECT_NEAR(depth_of_nearest_lamp(scene()).value(), 7, 1e-9);
    desc_.lamps[0].intensity = PerBand{40, 0, 40};
    EXPECT_NEAR(depth_of_nearest_lamp(scene()).value(), 14, 1e-9);
    desc_.lamps.push_back(isotropic_lamp({0, 3, 0}, 1));
    desc_.lamps.back().name = "near";
    EXPECT_NEAR(depth_of_nearest_lamp(scene()).value(), 3, 1e-9);
    desc_.lamps.resize(1);
    desc_.lamps[0].intensity = PerBand{0, 0, 0};
    EXPECT_FALSE(depth_of_nearest_lamp(scene()));
    desc_.lamps.clear();
    EXPECT_FALSE(depth_of_nearest_lamp(scene()));
}

TEST_F(FarLamps, AreNearWhereTheyLightASurfaceInView) {
    desc_.lamps[0].position = {0, 0, 9};
    EXPECT_NEAR(depth_of_nearest_lamp(scene()).value(), 9, 1e-9);
    desc_.geometry = {plane_at_z(10)};  // which the lamp lights
    EXPECT_NEAR(depth_of_nearest_lamp(scene()).value(), 1, 0.2);
    desc_.geometry = {plane_at_z(8)};  // from behind
    EXPECT_NEAR(depth_of_nearest_lamp(scene()).value(), 9, 1e-9);
}

TEST_F(FarLamps, AreWarnedOfInTheFastFormAlone) {
    const auto warned = [this] { return far_lamp_warning(scene()).has_value(); };
    desc_.lamps[0].position = {0, 0, -21};
    EXPECT_TRUE(warned());
    desc_.render.integrator = RenderDesc::Integrator::path;
    EXPECT_FALSE(warned());
    desc_.render = {};
    EXPECT_FALSE(warned());
    desc_.render.scattering = RenderDesc::Scattering::multiple;
    desc_.lamps[0].position = {0, 0, -19};
    EXPECT_FALSE(warned());
}

}  // namespace
}  // namespace uw::test
