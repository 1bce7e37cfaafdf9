// ctest labels: analytic
// Single scattering along one ray in uniform water, by each integrator, against quadrature over the
// distance along the ray.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/integrators/quadrature_integrator.h"
#include "core/integrators/reference_integrator.h"
#include "core/integrators/volume_integrator.h"
#include "media/light/deep_shadow_map.h"
#include "media/volumes/grid_field.h"
#include "tests/support/adaptive_quadrature.h"
#include "tests/support/hg_medium.h"
#include "tests/support/sphere_surface.h"
#include "tests/support/suns.h"

namespace uw::test {
namespace {

constexpr double k_g = 0.7;
constexpr std::size_t k_bands = 2;
const Spectrum k_intensity{{3, 2}};

double henyey_greenstein(double cosine) {
    return (1 - k_g * k_g) / (4 * std::numbers::pi) *
           std::pow(1 + k_g * k_g - 2 * k_g * cosine, -1.5);
}

/// One emitter in water with an absorption and a scattering coefficient per band, and a sphere.
class OneEmitter {
  public:
    OneEmitter(Lamp emitter, Medium medium, const SphereSurface& sphere)
        : medium_(std::move(medium)), sphere_(sphere), emitters_{std::move(emitter)} {}

    LitScene lit() const { return {&medium_, &nothing_, &sphere_, &emitters_}; }

    /// What the water between `begin` and `end` scatters towards the ray's origin, if it is lit.
    double between(const Ray& ray, double begin, double end, std::size_t band) const {
        const Lamp& lamp = emitters_.front();
        const double c = medium_.uniform.attenuation(static_cast<int>(band));
        const auto per_metre = [&](double s) {
            const Point3 x = ray.at(s);
            const Vector3 way = x - lamp.origin(x);
            const double radius = glm::length(way);
            const double cosine = glm::dot(way / radius, -ray.direction);
            return medium_.uniform.scattering[0][band] * henyey_greenstein(cosine) *
                   k_intensity[band] / lamp.spread(radius) * std::exp(-c * (s + radius));
        };
        return AdaptiveQuadrature::integrate(per_metre, begin, end, 1e-10);
    }

    std::unique_ptr<VolumeIntegrator> volume() const {
        const auto shadows = std::make_shared<DeepShadowMap>(
            nothing_, sphere_, emitters_.front().position(), DeepShadowOptions{64, 2, 1 << 20});
        return std::make_unique<VolumeIntegrator>(
            lit(), std::vector<std::shared_ptr<const DeepShadow>>{shadows},
            DepthTolerance(medium_, 0), VolumeIntegrator::Fineness{});
    }

  private:
    Medium medium_;
    GridField nothing_{{}, 0};
    SphereSurface sphere_;
    std::vector<Lamp> emitters_;
};

Medium murky() {
    return hg_medium(k_g, {0.2, 0.05}, {0.3, 0.2});
}
const SphereSurface k_aside({0, 0, -50}, 0.1);
const Ray k_slanted{{0.1, -0.2, 0}, glm::normalize(Vector3(0.2, 0.1, 1))};

Lamp lamp_at(const Point3& position) {
    return {"lamp", position, IsotropicProfile(), k_intensity};
}

Lamp sun() {
    return {"sun", {glm::normalize(Vector3(0.5, 1, 0.3)), k_sea_level}, k_intensity};
}

// The quadrature's error is at most the tolerance of 1e-7, relative to each ray's light.
TEST(QuadratureIntegrator, IsTheIntegralAlongTheRayForALampAndForASun) {
    for (const Lamp& emitter : {lamp_at({0.9, -0.4, 1.5}), sun()}) {
        const OneEmitter scene(emitter, murky(), k_aside);
        const std::vector<double> distances{0.8, 2, 6};
        InScatter light;
        QuadratureIntegrator(scene.lit(), 1e-7).in_scatter(k_slanted, distances, light);
        for (std::size_t i = 0; i < distances.size(); ++i)
            for (std::size_t band = 0; band < k_bands; ++band) {
                const double truth = scene.between(k_slanted, 0, distances[i], band);
                EXPECT_NEAR(light.at(i, 0)[band], truth, 1e-6 * truth)
                    << emitter.name() << " to " << distances[i] << " m";
            }
    }
}

// The shadow's edges are found to 2^-18 of a panel, of 500; without refinement they would be off by
// half a panel.
TEST(QuadratureIntegrator, RefinesTheEdgesOfShadows) {
    // The sphere lies between the lamp and the ray: in their plane, its shadow is bounded by the
    // lines through the lamp that touch it.
    const Ray ray{{0, 0, 0}, {0, 0, 1}};
    const OneEmitter scene(lamp_at({1, 0, 2}), murky(), SphereSurface({0.5, 0, 2.1}, 0.1));
    const double middle = std::atan2(0.1, 0.5), half = std::asin(0.1 / std::hypot(0.5, 0.1));
    const double begin = 2 + std::tan(middle - half), end = 2 + std::tan(middle + half);
    InScatter light;
    QuadratureIntegrator(scene.lit(), 1e-6).in_scatter(ray, std::vector<double>{5}, light);
    for (std::size_t band = 0; band < k_bands; ++band) {
        const double truth = scene.between(ray, 0, begin, band) + scene.between(ray, end, 5, band);
        EXPECT_NEAR(light.at(0, 0)[band], truth, 1e-5 * truth);
    }
}

// In clear water, a third of the light of a near lamp comes from beyond 15 m: what is left out is
// counted in optical depths, not in metres.
TEST(ReferenceIntegrator, ReachesFarInClearWater) {
    const OneEmitter scene(lamp_at({5, 0, 0}), hg_medium(k_g, {0.002, 0.004}, {0.001, 0.002}),
                           k_aside);
    const Ray ray{{0, 0, 0}, {0, 0, 1}};
    InScatter light;
    ReferenceIntegrator(scene.lit()).in_scatter(ray, std::vector<double>{200}, light);
    for (std::size_t band = 0; band < k_bands; ++band) {
        const double truth = scene.between(ray, 0, 200, band);
        EXPECT_GT(scene.between(ray, 20, 200, band), 0.05 * truth);
        // Midpoints of steps of 0.5 % of the distance from the lamp.
        EXPECT_NEAR(light.at(0, 0)[band], truth, 1e-4 * truth);
    }
}

// A ray that passes within the sphere of 1 mm that represents the lamp gathers nothing inside.
TEST(VolumeIntegrator, GathersNothingWithinTheLamp) {
    const double passes = 0.5 * k_lamp_radius;
    const OneEmitter scene(lamp_at({passes, 0, 2}), murky(), k_aside);
    const Ray ray{{0, 0, 0}, {0, 0, 1}};
    InScatter light;
    scene.volume()->in_scatter(ray, std::vector<double>{4}, light);
    const double half = std::sqrt(k_lamp_radius * k_lamp_radius - passes * passes);
    for (std::size_t band = 0; band < k_bands; ++band) {
        const double truth =
            scene.between(ray, 0, 2 - half, band) + scene.between(ray, 2 + half, 4, band);
        // Panels of an octave each with a few Gauss nodes: 1e-3 at the phase function's peak.
        EXPECT_NEAR(light.at(0, 0)[band], truth, 2e-3 * truth);
    }
}

}  // namespace
}  // namespace uw::test
