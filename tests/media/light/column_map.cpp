// ctest labels: analytic
#include "media/light/column_map.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/gaussian_field.h"
#include "tests/support/random_direction.h"

namespace uw::test {
namespace {

TEST(ColumnMap, MatchesTheClosedFormAndErrorFallsWithTheSquareOfTheVoxel) {
    const Point3 center{0.2, -0.1, 2.5};
    const Point3 lamp{-1.2, 0.4, 0};
    double error[2];
    double peak = 0;
    for (int level = 0; level < 2; ++level) {
        const GaussianField field(center, 0.3, 2.0, level == 0 ? 0.08 : 0.04);
        const ColumnMap map(field, lamp, 2, 1 << 28);
        std::mt19937 rng(3);
        std::vector<Point3> points(4000);
        for (Point3& p : points)
            p = center + std::uniform_real_distribution<double>(0, 2)(rng) * random_direction(rng);
        std::vector<double> columns(points.size());
        map.columns(points, columns);
        error[level] = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            double truth = 0;
            field.column(lamp, points[i], std::span<double>(&truth, 1));
            error[level] = std::max(error[level], std::abs(columns[i] - truth));
            peak = std::max(peak, truth);
        }
    }
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

}  // namespace
}  // namespace uw::test
