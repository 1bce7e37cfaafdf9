// ctest labels: analytic
// Single scattering along one ray in uniform water, by each integrator, against quadrature over the
// distance along the ray.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/light/reference_integrator.h"
#include "core/light/volume_integrator.h"
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
        const double tolerance = 1e-9 * std::max(per_metre(begin), per_metre(end));
        return AdaptiveQuadrature::integrate(per_metre, begin, end, tolerance);
    }

    std::unique_ptr<VolumeIntegrator> volume() const {
        const auto shadows = std::make_shared<DeepShadowMap>(
            nothing_, sphere_, emitters_.front().position(), DeepShadowOptions{64, 2, 1 << 20});
        return std::make_unique<VolumeIntegrator>(
            lit(), std::vector<std::shared_ptr<const DeepShadow>>{shadows},
            DepthTolerance(medium_, 0), VolumeIntegrator::Fineness{}, VolumeIntegrator::Part{});
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

// In clear water, a near lamp lights what lies far away: what is left out is counted in optical
// depths, not in metres.
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

// Whether rays cross a beam, graze it or run along it: what is soft is resolved where each ray
// comes nearest to its axis, not only where the beam is bright. Without it those that graze were a
// third off.
TEST(VolumeIntegrator, ResolvesSoftBeamsHoweverARayPassesThem) {
    using Falloff = SpotProfileDesc::Falloff;
    const Point3 position{0.3, 0.1, 0};
    const LampPlacement placement{{}, glm::normalize(Vector3(0.05, -0.02, 1))};
    std::vector<std::pair<LampProfile, double>> beams;  // and their half-angle [rad]
    for (const double fwhm : {0.5, 2.0, 8.0, 20.0, 90.0})
        beams.emplace_back(CosineProfile({fwhm}, placement), glm::radians(0.5 * fwhm));
    for (const auto& [beam, edge] : {std::pair{2.0, 1.0}, {20.0, 10.0}, {60.0, 40.0}})
        for (const Falloff falloff : {Falloff::smooth, Falloff::gltf, Falloff::blender})
            beams.emplace_back(SpotProfile({beam, edge, falloff}, placement),
                               glm::radians(0.5 * (beam + edge)));
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> along(0.3, 6), across(-1.5, 1.5);
    for (const auto& [profile, half_angle] : beams) {
        const OneEmitter scene({"lamp", position, profile, k_intensity}, murky(), k_aside);
        const auto volume = scene.volume();
        const QuadratureIntegrator truth(scene.lit(), 1e-7);
        SCOPED_TRACE(scene.lit().emitters->front().profile_name());
        for (int n = 0; n < 100; ++n) {
            // Aimed at a point near the beam, or at its edge.
            const double far = along(rng), wide = far * std::tan(std::min(half_angle, 0.8));
            const Point3 aim =
                position + far * placement.axis() + wide * Vector3(across(rng), across(rng), 0.0);
            const Ray ray{{0, 0, 0}, glm::normalize(aim - Point3(0, 0, 0))};
            InScatter light, exact;
            volume->in_scatter(ray, std::vector<double>{8}, light);
            truth.in_scatter(ray, std::vector<double>{8}, exact);
            // Panels of two to four Gauss nodes. The floor is 1e-8 of such a beam seen from within.
            for (std::size_t band = 0; band < k_bands; ++band)
                EXPECT_NEAR(light.at(0, 0)[band], exact.at(0, 0)[band],
                            6e-4 * exact.at(0, 0)[band] + 1e-9)
                    << "half-angle " << half_angle << " of a beam, ray " << n;
        }
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

/// Nothing of one constituent and the same of another everywhere, with a knot at every metre.
class SecondOfTwo : public ConcentrationField {
  public:
    int constituent_count() const override { return 2; }
    Bounds bounds() const override { return {{-1e3, -1e3, -1e3}, {1e3, 1e3, 1e3}}; }
    double finest_voxel() const override { return 1; }
    void sample(const Point3&, std::span<double> concentration) const override {
        concentration[0] = 0;
        concentration[1] = 1;
    }
    void column(const Point3& a, const Point3& b, std::span<double> column) const override {
        column[0] = 0;
        column[1] = distance(a, b);
    }
    void profile(const Ray&, double s_end, ConcentrationProfile& profile) const override {
        profile.constituent_count = 2;
        profile.s.clear();
        profile.concentration.clear();
        for (double s = 0; s <= s_end; s += 1) {
            profile.s.push_back(s);
            profile.concentration.insert(profile.concentration.end(), {0, 1});
        }
        profile.integrate();
    }
};

/// The shadow of a lamp in that water, without surfaces.
class ClearShadow : public DeepShadow {
  public:
    ClearShadow(const ConcentrationField& field, const Point3& lamp) : field_(field), lamp_(lamp) {}
    void lit_intervals(const Ray&, const Interval& stretch,
                       std::vector<Interval>& lit) const override {
        lit.assign(1, stretch);
    }
    void append_column_breaks(const Ray&, const Interval&, std::vector<double>&) const override {}
    void columns(std::span<const Point3> x, std::span<double> column) const override {
        for (std::size_t i = 0; i < x.size(); ++i)
            field_.column(lamp_, x[i], column.subspan(2 * i, 2));
    }
    std::size_t bytes() const override { return 0; }

  private:
    const ConcentrationField& field_;
    Point3 lamp_;
};

// Over each metre the light falls by 17 optical depths, to which panels must be cut whichever
// constituent is the thick one.
TEST(VolumeIntegrator, CutsPanelsToTheOpticalDepthOfAllConstituents) {
    const Point3 position{0.3, 0, -0.5};
    const std::vector<Lamp> emitters{lamp_at(position)};
    const SecondOfTwo field;
    Medium medium = murky();
    add_particles(medium, {0.01, 0.01}, {0.01, 0.01});
    add_particles(medium, {6, 5}, {2, 3});
    const LitScene lit{&medium, &field, &k_aside, &emitters};
    const VolumeIntegrator volume(lit, {std::make_shared<ClearShadow>(field, position)},
                                  DepthTolerance(medium, 0), {.knots_per_panel = 1}, {});
    const OneEmitter as_thick(emitters[0], hg_medium(k_g, {6.2, 5.05}, {2.3, 3.2}), k_aside);
    const Ray ray{{0, 0, 0}, {0, 0, 1}};
    InScatter light;
    for (const double begin : {0.0, 1.0, 2.0}) {
        volume.in_scatter_from(ray, begin, std::vector<double>{begin + 1}, light);
        for (std::size_t band = 0; band < k_bands; ++band) {
            const double truth = as_thick.between(ray, begin, begin + 1, band);
            // Two Gauss nodes on panels of 1.5 optical depths.
            EXPECT_NEAR(light.at(0, 0)[band], truth, 2e-3 * truth) << begin;
        }
    }
}

}  // namespace
}  // namespace uw::test
