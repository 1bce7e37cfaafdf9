// ctest labels: analytic
#include "core/light/reference_integrator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "core/light/ray_panels.h"
#include "tests/support/hg_medium.h"
#include "tests/support/sphere_surface.h"

namespace uw::test {
namespace {

/// Nothing but the water, at most so many steps of which are taken.
class CountedWater final : public ConcentrationField {
  public:
    explicit CountedWater(std::size_t most) : most_(most) {}

    const std::atomic<bool>& stop() const { return stop_; }
    int constituent_count() const override { return 0; }
    Bounds bounds() const override { return {}; }
    double finest_voxel() const override { return 0; }
    void sample(const Point3&, std::span<double>) const override {
        if (++steps_ > most_) stop_ = true;
    }
    void column(const Point3&, const Point3&, std::span<double>) const override {}
    void profile(const Ray&, double, ConcentrationProfile&) const override {}

  private:
    std::size_t most_;
    mutable std::size_t steps_ = 0;
    mutable std::atomic<bool> stop_{false};
};

// Steps of the scale on which one band's light ends, as far as that of another reaches, would be
// 10^10 of them.
TEST(ReferenceIntegrator, TakesSunlightInWaterClearInOneBandAndBlackInAnother) {
    constexpr double k_clear = 1e-5, k_black = 300;
    const Medium medium = hg_medium(0.0, {k_clear, k_black / 2}, {k_clear, k_black / 2});
    const CountedWater water(1'000'000);
    const SphereSurface nothing({0, 0, -5}, 0.1);
    for (const double y : {-0.4, 0.0, 0.4}) {
        const Sunlight sun{glm::normalize(Vector3(0.3, 1, 0)), {{0, -0.01, 0}, {0, -1, 0}}};
        const std::vector<Lamp> lamps{{"sun", sun, Spectrum{1, 1}}};
        const ReferenceIntegrator integrator({&medium, &water, &nothing, &lamps});
        const Ray ray{{0, 0, 0}, glm::normalize(Vector3(0, y, 1))};
        const StopScope scope(water.stop());
        InScatter result;
        constexpr std::array k_distances{1e4};
        integrator.in_scatter(ray, k_distances, result);
        const double slope = sun.slope(ray.direction), begin = sun.length_to(ray.origin);
        // Where the ray leaves the water.
        const double end = slope < 0 ? std::min(1e4, -begin / slope) : 1e4;
        for (std::size_t b = 0; b < 2; ++b) {
            const double c = b == 0 ? 2 * k_clear : k_black, rate = c * (1 + slope);
            const double expected = c / 2 / (4 * std::numbers::pi) * std::exp(-c * begin) *
                                    -std::expm1(-rate * end) / rate;
            // A step's 0.005, with which the last may cross the surface.
            EXPECT_NEAR(result.at(0, 0)[b], expected, 5e-3 * expected) << y << ", band " << b;
        }
    }
}

/// Particles of 1 ppm in a cube of 2 m, in voxels of 0.1 m.
class Cloud final : public ConcentrationField {
  public:
    int constituent_count() const override { return 1; }
    Bounds bounds() const override { return {{-1, -1, -1}, {1, 1, 1}}; }
    double finest_voxel() const override { return 0.1; }
    void sample(const Point3& x, std::span<double> concentration) const override {
        concentration[0] = std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}) <= 1 ? 1 : 0;
    }
    void column(const Point3& from, const Point3& to, std::span<double> column) const override {
        const double length = distance(from, to);
        const Interval within = inside({from, (to - from) / length}, bounds());
        column[0] = std::max(0.0, std::min(length, within.end) - std::max(0.0, within.begin));
    }
    void profile(const Ray&, double, ConcentrationProfile&) const override {}
};

// Eight optical depths to a voxel: quarters of it would make the light 15 % too little.
TEST(ReferenceIntegrator, StepsByTenthsOfAnOpticalDepthInDenseClouds) {
    constexpr double k_a = 40, k_b = 40, k_c = k_a + k_b, k_above = 0.05;
    Medium medium = hg_medium(0.0, {0.0}, {0.0});
    add_particles(medium, {k_a}, {k_b});
    const Cloud cloud;
    const SphereSurface nothing({0, 0, -5}, 0.1);
    const Sunlight sun{{0, 1, 0}, {{0, -k_above, 0}, {0, -1, 0}}};
    const std::vector<Lamp> lamps{{"sun", sun, Spectrum{1}}};
    const ReferenceIntegrator integrator({&medium, &cloud, &nothing, &lamps});
    InScatter result;
    constexpr std::array k_distances{0.02, 3.0};
    integrator.in_scatter({{0, 0, 0}, {0, 0, 1}}, k_distances, result);
    for (std::size_t i = 0; i < 2; ++i) {
        const double expected = k_b / (4 * std::numbers::pi) * std::exp(-k_c * k_above) *
                                -std::expm1(-k_c * k_distances[i]) / k_c;
        // The error of the midpoint rule: 0.1^2 / 24.
        EXPECT_NEAR(result.at(i, 0)[0], expected, 5e-4 * expected);
    }
}

}  // namespace
}  // namespace uw::test
