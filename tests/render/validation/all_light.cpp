// ctest labels: statistical
#include "render/validation/light_trial.h"

#include <gtest/gtest.h>

#include "core/paths/path_tracer.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

/// A box before a wall and a lamp beside the camera.
SceneDesc small_scene(int width = 32, int height = 24) {
    SceneDesc desc = pinhole_scene(width, height);
    desc.geometry = {plane_at_z(3), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
    desc.lamps = {isotropic_lamp({-0.5, -0.2, 0}, 40)};
    desc.water.absorption = PerBand{0.3, 0.1, 0.1};
    desc.water.scattering = ScatteringDesc{{0.2, 0.2, 0.3}, {}};
    desc.water.scattering->phase.function = HenyeyGreensteinDesc{0.8};
    desc.render.scattering = RenderDesc::Scattering::multiple;
    return desc;
}

TEST(AllLight, OfTheFastFormIsThatOfLightPaths) {
    const LightValidation result = validate_all_light(small_scene(), "scene", {});
    EXPECT_TRUE(result.passed());
    ASSERT_EQ(result.checks.size(), 9U);
    ASSERT_EQ(result.parts.size(), 3U);
    for (const LightParts& parts : result.parts) EXPECT_GT(parts.ratio(), 1.2);
    EXPECT_EQ(result.checks[8].light, "multiple, 450 nm");
}

// By light paths in water that scatters a tenth more than the scene's.
TEST(AllLight, IsFoundWrongWhereTheFastFormIs) {
    SceneDesc murky = small_scene();
    for (double& b : murky.water.scattering->b) b *= 1.1;
    Renderer other;
    other.set_scene(std::move(murky));
    const TransportChange murkier = [&other](LightTransport transport) {
        transport.paths = std::make_shared<PathTracer>(other.assemble().lit());
        return transport;
    };
    const LightValidation result = validate_all_light(small_scene(), "scene", {}, murkier);
    EXPECT_FALSE(result.passed());
}

TEST(AllLight, IsFoundMissingWhereThereIsNone) {
    const TransportChange without_paths = [](LightTransport transport) {
        transport.paths = nullptr;
        return transport;
    };
    EXPECT_FALSE(validate_all_light(small_scene(8, 6), "scene", {}, without_paths).passed());
}

}  // namespace
}  // namespace uw::test
