// ctest labels: analytic
// Light of a lamp on a plane in uniform water, by the closed form.
#include "core/light/surface_lighting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "core/light/reference_integrator.h"
#include "tests/support/planes_scene.h"
#include "tests/support/sphere_surface.h"

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

TEST(SurfaceLighting, ASphereCastsItsShadow) {
    const TestScene scene(uniform_scene({0, 0, 0}));
    const SphereSurface sphere({0, 0, 1}, 0.1);
    const std::vector<Lamp> emitters{
        {"lamp", {0, 0, 0}, IsotropicProfile(), Spectrum{{1, 1, 1}}},
        {"sun", {{0, 0, 1}, {{0, 0, 0}, {0, 0, -1}}}, Spectrum{{1, 1, 1}}}};
    LitScene lit = scene.assembled().lit();
    lit.surfaces = &sphere;
    lit.emitters = &emitters;
    // Twice as far away as the sphere, the shadow of the lamp is twice as wide, to within 1 %; that
    // of the sun is as wide.
    for (const auto& [x, by_lamp, by_sun] : {std::tuple{0.0, false, false},
                                             {0.099, false, false},
                                             {0.101, false, true},
                                             {0.198, false, true},
                                             {0.204, true, true},
                                             {1.0, true, true}}) {
        SurfaceSample sample;
        sample.hit.position = {x, 0, 2};
        sample.hit.normal = sample.hit.geometric_normal = {0, 0, -1};
        SurfaceLight direct, closed;
        DirectLighting(lit).evaluate_one(sample, direct);
        UniformWaterLighting(lit).evaluate_one(sample, closed);
        for (const SurfaceLight* light : {&direct, &closed}) {
            EXPECT_EQ(light->visible(0, 0), by_lamp) << x;
            EXPECT_EQ(light->visible(0, 1), by_sun) << x;
        }
    }
}

/// A sphere far away that counts the shadow rays.
class CountedSurfaces : public SphereSurface {
  public:
    CountedSurfaces() : SphereSurface({0, 0, -50}, 0.1) {}
    bool occluded(const Point3& from, const Point3& to) const override {
        ++count;
        return SphereSurface::occluded(from, to);
    }
    mutable int count = 0;
};

TEST(SurfaceLighting, TracesShadowRaysOnlyWhereALampMayShine) {
    const TestScene scene(uniform_scene({0, 0, 0}));
    const CountedSurfaces surfaces;
    const std::vector<Lamp> spot{
        {"spot", {0, 0, 0}, SpotProfile({20, 10}, {}), Spectrum{{1, 1, 1}}}};
    LitScene lit = scene.assembled().lit();
    lit.surfaces = &surfaces;
    lit.emitters = &spot;
    // In the beam, beside it, and turned away from the lamp.
    std::vector<SurfaceSample> samples(3);
    for (const auto& [i, x, facing] : {std::tuple{0, 0.0, -1}, {1, 2.0, -1}, {2, 0.1, 1}}) {
        SurfaceHit& hit = samples[static_cast<std::size_t>(i)].hit;
        hit.position = {x, 0, 2};
        hit.normal = hit.geometric_normal = {0, 0, facing};
        hit.distance = 2;
    }
    const std::vector<const SurfaceSample*> all{&samples[0], &samples[1], &samples[2]};
    SurfaceLight light;
    DirectLighting(lit).evaluate(all, light);
    EXPECT_EQ(surfaces.count, 1);
    EXPECT_TRUE(light.visible(0, 0));
    EXPECT_FALSE(light.visible(1, 0));
    EXPECT_FALSE(light.visible(2, 0));
}

}  // namespace
}  // namespace uw::test
