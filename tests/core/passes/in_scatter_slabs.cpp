// ctest labels: analytic
// One ray's light in slabs of uniform water, by closed forms.
#include "core/passes/forward_images.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/planes_scene.h"

namespace uw::test {
namespace {

TEST(InScatterSlabs, WeightsAreTheIntegralsOfTheTransmittance) {
    const TestScene scene(uniform_scene({1, -0.5, 0}));
    const LitScene lit = scene.assembled().lit();
    const LampPaths paths(lit, [](std::size_t, const Point3&, std::span<double>) {});
    const InScatterSlabs slabs(lit, scene.integrator(), paths, Affine(), {0, 1, 3, 4}, false, {});
    const Ray ray{{0, 0, 0}, {0, 0, 1}};
    const double end = 2.5;  // within the second slab
    std::vector<SlabLight> lights;
    slabs.integrate(ray, end, 0, 3, lights);
    ASSERT_EQ(lights.size(), 3U);
    EXPECT_TRUE(lights[0].visible);
    EXPECT_TRUE(lights[1].visible);
    EXPECT_FALSE(lights[2].visible);
    InScatter light;
    scene.integrator().in_scatter(ray, std::vector<double>{1, end}, light);
    for (std::size_t band = 0; band < 3; ++band) {
        const double c = lit.medium->uniform.attenuation(static_cast<int>(band));
        const auto integral = [&](double a, double b) {
            return (std::exp(-c * a) - std::exp(-c * b)) / c;
        };
        // The whole slab's weight, but the mean light of what is seen of it.
        EXPECT_NEAR(lights[0].weight[band], integral(0, 1), 1e-12);
        EXPECT_NEAR(lights[1].weight[band], integral(1, 3), 1e-12);
        const double first = light.at(0, 0)[band], second = light.at(1, 0)[band] - first;
        // Panels lie elsewhere when a ray's light begins at the slab.
        EXPECT_NEAR(lights[0].lamps[0][band], first / integral(0, 1), 1e-3 * first);
        EXPECT_NEAR(lights[1].lamps[0][band] * integral(1, end), second, 1e-3 * second);
    }
    // From the middle of what is seen.
    EXPECT_NEAR(lights[1].to_camera.length, 1.75, 1e-12);
    EXPECT_NEAR(lights[1].to_lamps.length, std::sqrt(1.25 + 1.75 * 1.75), 1e-12);
}

}  // namespace
}  // namespace uw::test
