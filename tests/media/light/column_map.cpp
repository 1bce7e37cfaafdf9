// ctest labels: analytic
#include "media/light/column_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/support/column_errors.h"
#include "tests/support/gaussian_field.h"
#include "tests/support/random_direction.h"
#include "tests/support/tolerance.h"

namespace uw::test {
namespace {

// A field in bounds much wider than its own, so that nothing tells where it lies.
class WideField : public ConcentrationField {
  public:
    explicit WideField(const ConcentrationField& inner) : inner_(inner) {}
    int constituent_count() const override { return inner_.constituent_count(); }
    Bounds bounds() const override { return {{-1, -1, 1.5}, {1, 1, 2.5}}; }
    double finest_voxel() const override { return inner_.finest_voxel(); }
    void sample(const Point3& x, std::span<double> concentration) const override {
        inner_.sample(x, concentration);
    }
    void column(const Point3& a, const Point3& b, std::span<double> column) const override {
        inner_.column(a, b, column);
    }
    void profile(const Ray& ray, double s_end, ConcentrationProfile& profile) const override {
        inner_.profile(ray, s_end, profile);
    }

  private:
    const ConcentrationField& inner_;
};

// A layer across the lamp's rays, 1 - cos(2 pi (z - begin)): of a column per metre of which the
// second derivative is 2 pi, and everywhere alike to either side.
class Layer : public ConcentrationField {
  public:
    static constexpr double k_begin = 2;

    int constituent_count() const override { return 1; }
    Bounds bounds() const override { return {{-0.2, -0.2, k_begin}, {0.3, 0.3, k_begin + 1}}; }
    double finest_voxel() const override { return 0.02; }
    void sample(const Point3& x, std::span<double> concentration) const override {
        const bool is_inside = x.z > k_begin && x.z < k_begin + 1;
        concentration[0] = is_inside ? 1 - std::cos(2 * std::numbers::pi * (x.z - k_begin)) : 0;
    }
    void column(const Point3& a, const Point3& b, std::span<double> column) const override {
        const auto up_to = [](double z) {
            const double t = std::clamp(z - k_begin, 0.0, 1.0);
            return t - std::sin(2 * std::numbers::pi * t) / (2 * std::numbers::pi);
        };
        column[0] = distance(a, b) / std::abs(b.z - a.z) * std::abs(up_to(b.z) - up_to(a.z));
    }
    void profile(const Ray& ray, double s_end, ConcentrationProfile& p) const override {
        p.constituent_count = 1;
        p.s.assign({0.0});
        const double first = k_begin / ray.direction.z, last = (k_begin + 1) / ray.direction.z;
        for (int i = 0; i <= 100; ++i) p.s.push_back(first + 0.01 * i * (last - first));
        if (s_end > last) p.s.push_back(s_end);
        p.concentration.resize(p.s.size());
        p.column.assign(p.s.size(), 0.0);
        for (std::size_t i = 1; i < p.s.size(); ++i) {
            sample(ray.at(p.s[i]), std::span<double>(&p.concentration[i], 1));
            column(ray.origin, ray.at(p.s[i]), std::span<double>(&p.column[i], 1));
        }
    }
};

TEST(ColumnMap, MatchesTheClosedFormAndErrorFallsWithTheSquareOfTheVoxel) {
    const Point3 lamp{-1.2, 0.4, 0};
    const auto [error, peak] = column_errors(
        [&](const GaussianField& field) { return ColumnMap(field, lamp, 2, 1 << 28); },
        [&](const Point3& /*x*/) { return lamp; });
    // Bilinear interpolation over texels one voxel wide: h^2/8 of the second derivative, which is
    // peak/sigma^2 for a Gaussian, in two directions plus that along the ray.
    EXPECT_LT(error[0], 3 * 0.08 * 0.08 / 8 / (0.3 * 0.3) * peak);
    EXPECT_LT(error[1], 0.35 * error[0]);
}

TEST(ColumnMap, LampInsideTheCloudSeesAllDirections) {
    const GaussianField field({0, 0, 0}, 0.5, 1.0, 0.05);
    const Point3 lamp{0.1, 0.2, -0.1};
    const ColumnMap map(field, lamp, 2, 1 << 28);
    std::mt19937 rng(5);
    for (int n = 0; n < 2000; ++n) {
        const Point3 x =
            lamp + std::uniform_real_distribution<double>(0.01, 4)(rng) * random_direction(rng);
        double got = 0, truth = 0;
        map.columns(std::span<const Point3>(&x, 1), std::span<double>(&got, 1));
        field.column(lamp, x, std::span<double>(&truth, 1));
        EXPECT_NEAR(got, truth, 2e-3);  // columns reach 0.6
    }
}

TEST(ColumnMap, MemoryBudgetIsKept) {
    const GaussianField field({0, 0, 2}, 0.3, 1.0, 0.01);
    const std::size_t budget = 4 << 20;
    const ColumnMap map(field, {0, 0, 0}, 2, budget);
    EXPECT_GT(map.bytes(), budget / 8);
    EXPECT_LT(map.bytes(), 2 * budget);
}

TEST(ColumnMap, ToleranceSavesRaysAndIsKept) {
    const Point3 center{0.2, -0.1, 2.5}, lamp{-1.2, 0.4, 0};
    const GaussianField field(center, 0.3, 2.0, 0.04);
    const ColumnMap exact(field, lamp, 2, 1 << 28);
    std::uint64_t rays_before = exact.rays_traced();
    for (const double tolerance : {1e-3, 1e-2, 1e-1}) {
        const ColumnMap map(field, lamp, 2, 1 << 28, column_tolerance(tolerance));
        EXPECT_LE(map.rays_traced(), rays_before);
        EXPECT_LT(map.bytes(), exact.bytes());
        rays_before = map.rays_traced();
        std::mt19937 rng(7);
        for (int n = 0; n < 4000; ++n) {
            const Point3 x =
                center + std::uniform_real_distribution<double>(0, 2)(rng) * random_direction(rng);
            double got = 0, truth = 0;
            map.columns(std::span<const Point3>(&x, 1), std::span<double>(&got, 1));
            field.column(lamp, x, std::span<double>(&truth, 1));
            // An error counts e^-column; between rays half as far apart as those tested, and
            // between samples along them, it is within the tolerance each. Texels have 6e-4.
            EXPECT_LT(std::abs(got - truth) * std::exp(-truth), 2 * tolerance + 6e-4);
        }
    }
    EXPECT_LT(rays_before, exact.rays_traced() / 3);
}

TEST(ColumnMap, ErrorsAlongRaysAreAFifthOfTheTolerance) {
    const Point3 lamp{0, 0, 0};
    const Layer layer;
    const double tolerance = 0.02;
    const ColumnMap map(layer, lamp, 2, 1 << 28, column_tolerance(tolerance));
    double largest = 0;
    for (int n = 0; n < 2000; ++n) {
        const Point3 x{0.1, 0.05, Layer::k_begin + 0.0005 * n};
        double got = 0, truth = 0;
        map.columns(std::span<const Point3>(&x, 1), std::span<double>(&got, 1));
        layer.column(lamp, x, std::span<double>(&truth, 1));
        largest = std::max(largest, std::abs(got - truth) * std::exp(-truth));
    }
    // Between rays, two voxels apart, columns differ by their slope alone: 1e-4 of them at most.
    EXPECT_LT(largest, tolerance / 5 + 2e-4);
    // It is made use of.
    EXPECT_GT(largest, tolerance / 50);
}

TEST(ColumnMap, ToleranceKeepsASharpShadow) {
    // A cloud whose edge is narrower than the widest spacing of rays.
    const Point3 center{0, 0, 2}, lamp{0, 0, 0};
    const GaussianField field(center, 0.03, 20.0, 0.03);
    const ColumnMap map(field, lamp, 2, 1 << 28, column_tolerance(0.01));
    std::mt19937 rng(9);
    for (int n = 0; n < 4000; ++n) {
        const Point3 x =
            center + std::uniform_real_distribution<double>(0, 0.2)(rng) * random_direction(rng);
        double got = 0, truth = 0;
        map.columns(std::span<const Point3>(&x, 1), std::span<double>(&got, 1));
        field.column(lamp, x, std::span<double>(&truth, 1));
        // Texels of half a sigma: h^2/8 in each of three directions, of a peak of 1.5.
        EXPECT_LT(std::abs(got - truth) * std::exp(-truth), 2 * 0.01 + 3 * 0.25 / 8 * 1.5);
    }
}

TEST(ColumnMap, ToleranceKeepsTheShadowOfACloudOfOneVoxel) {
    const double voxel = 0.02, tolerance = 0.01;
    std::mt19937 rng(10);
    std::uniform_real_distribution<double> offset(-0.3, 0.3);
    for (int n = 0; n < 60; ++n) {
        const Point3 lamp{0, 0, 0}, center{offset(rng), offset(rng), 2};
        const GaussianField cloud(center, 0.5 * voxel, 40.0, voxel);  // a column of 1
        const WideField field(cloud);
        const ColumnMap every_ray(field, lamp, 2, 1 << 28);
        const ColumnMap map(field, lamp, 2, 1 << 28, column_tolerance(tolerance));
        EXPECT_LT(map.rays_traced(), every_ray.rays_traced() / 3);
        double got = 0, truth = 0;
        const Point3 behind = center + 0.1 * (center - lamp);
        map.columns(std::span<const Point3>(&behind, 1), std::span<double>(&got, 1));
        every_ray.columns(std::span<const Point3>(&behind, 1), std::span<double>(&truth, 1));
        // One tolerance between rays, and one along them.
        EXPECT_NEAR(got, truth, 2 * tolerance * std::exp(truth)) << n;
    }
}

TEST(ColumnMap, BreaksFallOnlyWhereTheLightHasMetParticles) {
    const GaussianField field({0, 0, 2}, 0.1, 1.0, 0.05);
    const ColumnMap map(field, {0, 0, 0}, 2, 1 << 26);
    std::vector<double> s;
    map.append_breaks({{-1, 0, 4}, {1, 0, 0}}, {0, 2}, s);  // across the cloud's shadow
    EXPECT_GT(s.size(), 10u);
    for (const double at : s) EXPECT_TRUE(at >= 0 && at <= 2);
    s.clear();
    map.append_breaks({{-1, 3, 0.5}, {1, 0, 0}}, {0, 2}, s);  // far from it
    EXPECT_LE(s.size(), 2u);
}

TEST(ColumnMap, NoBreaksOnTheSidesOfTheLampWithoutParticles) {
    const GaussianField field({0, 0, 2}, 0.1, 1.0, 0.05);
    const ColumnMap map(field, {0, 0, 0}, 2, 1 << 26);
    std::vector<double> s;
    map.append_breaks({{-1, 0, -2}, {1, 0, 0}}, {0, 2}, s);   // behind the lamp
    map.append_breaks({{-2, 0, 0.1}, {0, 1, 0}}, {0, 1}, s);  // beside it
    EXPECT_TRUE(s.empty());
}

}  // namespace
}  // namespace uw::test
