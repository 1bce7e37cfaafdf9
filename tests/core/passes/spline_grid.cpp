// ctest labels: unit analytic
#include "core/passes/spline_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {
namespace {

// Small prime factors, no more nodes than pixels, at least 16 where there are as many.
TEST(SplineLine, HasNodesThatTransformFast) {
    EXPECT_EQ(SplineLine::node_count(1280, 8), 160);
    EXPECT_EQ(SplineLine::node_count(1279, 8), 160);
    EXPECT_EQ(SplineLine::node_count(721, 2), 375);
    EXPECT_EQ(SplineLine::node_count(97, 1), 97);
    EXPECT_EQ(SplineLine::node_count(40, 8), 16);
    EXPECT_EQ(SplineLine::node_count(9, 8), 9);
}

RowSource rows_of(const Grid2D<double>& image) {
    return [&image](int y, std::span<double> row) {
        std::ranges::copy(image.row(y), row.begin());
        return true;
    };
}

// Cosines that the reflection continues smoothly: the mean about a node is the cosine there times
// the spline's response, and so are the value at a node and at a pixel of coefficients.
TEST(SplineGrid, MultipliesWavesByItsResponse) {
    const int width = 75, height = 48, across = 3, down = 2;
    const SplineGrid grid(width, height, 3);
    ASSERT_EQ(grid.columns(), 25);
    ASSERT_EQ(grid.rows(), 16);
    const auto wave = [&](double x, double y) {
        return std::cos(std::numbers::pi * across * x) * std::cos(std::numbers::pi * down * y);
    };
    Grid2D<double> image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image(x, y) = wave((x + 0.5) / width, (y + 0.5) / height);
    Grid2D<float> coefficients(25, 16), means, values;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 25; ++x)
            coefficients(x, y) = static_cast<float>(wave((x + 0.5) / 25, (y + 0.5) / 16));
    grid.means(rows_of(image), means);
    grid.values(coefficients, values);
    const double response = grid.x().response(across) * grid.y().response(down);
    EXPECT_LT(response, 0.95);
    // What the spline leaves of the nearest alias, at 23 and 14 parts of 25 and 16: (3 / 47)^6.
    constexpr double k_alias = 1e-6;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 25; ++x) {
            const double truth = response * static_cast<double>(coefficients(x, y));
            EXPECT_NEAR(static_cast<double>(means(x, y)), truth, k_alias);
            EXPECT_NEAR(static_cast<double>(values(x, y)), truth, k_alias);
        }
    grid.interpolate(coefficients, [&](int y, std::span<const double> row) {
        for (int x = 0; x < width; ++x) {
            const double truth = response * image(x, y);
            EXPECT_NEAR(row[static_cast<std::size_t>(x)], truth, k_alias);
            const auto [first, second] = grid.at(coefficients, values, x, y);
            EXPECT_NEAR(static_cast<double>(first), truth, k_alias);
            EXPECT_NEAR(static_cast<double>(second), response * truth, 2 * k_alias);
        }
    });
}

}  // namespace
}  // namespace uw
