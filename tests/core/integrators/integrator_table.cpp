// ctest labels: unit
// What each integrator that users can name states of itself.
#include "core/integrators/integrator_table.h"

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

}  // namespace
}  // namespace uw::test
