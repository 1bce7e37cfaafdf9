// ctest labels: analytic
// Light of a lamp on a plane in uniform water, by the closed form.
#include "core/integrators/surface_lighting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/integrators/quadrature_integrator.h"
#include "tests/support/planes_scene.h"

namespace uw::test {
namespace {

TEST(SurfaceLighting, IsTheClosedFormOnAPlaneBeforeALamp) {
    SceneDesc desc = pinhole_scene(8, 8);
    desc.geometry = {plane_at_z(2)};
    desc.lamps = {isotropic_lamp({0.5, 0, 0.5}, 3)};
    const TestScene scene(desc);
    const LitScene lit = scene.assembled().lit();
    SurfaceSample sample;
    sample.ray = {{0, 0, 0}, {0, 0, 1}};
    ASSERT_TRUE(lit.surfaces->closest_hit(sample.ray, k_far, sample.hit));
    const Vector3 way{0.5, 0, -1.5};  // from the hit to the lamp
    const double r = glm::length(way), c = lit.medium->uniform.attenuation(1);
    const double clean = 3 / (r * r) * 1.5 / r;
    SurfaceLight direct, closed;
    DirectLighting(lit).evaluate_one(sample, direct);
    UniformWaterLighting(lit).evaluate_one(sample, closed);
    for (const SurfaceLight* light : {&direct, &closed}) {
        ASSERT_TRUE(light->visible(0, 0));
        // Embree's hit is a float; fast_exp is exact to 1e-11.
        EXPECT_NEAR(light->clean(0, 0, 1), clean, 1e-6 * clean);
        EXPECT_NEAR(light->irradiance(0, 0, 1), clean * std::exp(-c * r), 1e-6 * clean);
        EXPECT_NEAR(light->to_camera(0)[1], std::exp(-c * 2), 1e-6);
    }
}

}  // namespace
}  // namespace uw::test
