// ctest labels: unit analytic
#include "core/light/strata.h"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "tests/support/adaptive_quadrature.h"

namespace uw {
namespace {

using namespace uw::test;

const Point3 k_strata_surface{1, 5, -2};
const Vector3 k_strata_up = glm::normalize(Vector3(0.1, 1, -0.2));

Strata bent() {
    return {k_strata_surface, k_strata_up, {1, 2, 4, 7}, {{0, {0.5, 2, 0, 1}}, {2, {0, 0, 3, 3}}}};
}

// Written out apart from the class: held beyond the ends, linear between.
double bent_concentration(double depth) {
    if (depth <= 1) return 0.5;
    if (depth <= 2) return 0.5 + 1.5 * (depth - 1);
    if (depth <= 4) return 2 - (depth - 2);
    return depth <= 7 ? (depth - 4) / 3 : 1;
}

TEST(Strata, ColumnsAreIntegralsOfSamples) {
    const Strata strata = bent();
    std::mt19937 random(3);
    std::uniform_real_distribution<double> at(-9, 9);
    for (int n = 0; n < 200; ++n) {
        const Point3 a{at(random), at(random), at(random)}, b{at(random), at(random), at(random)};
        std::array<double, 3> column{0.25, 0, 0};
        strata.add_column(a, b, column);
        const double length = distance(a, b);
        const double expected = AdaptiveQuadrature::integrate(
            [&](double t) {
                const Point3 x = a + t * (b - a);
                return length * bent_concentration(-glm::dot(x - k_strata_surface, k_strata_up));
            },
            0, 1, 1e-11);
        EXPECT_NEAR(column[0], 0.25 + expected, 1e-9);  // it adds
        EXPECT_EQ(column[1], 0);
        std::array<double, 3> there{};
        strata.add_sample(a, there);
        EXPECT_NEAR(there[0], bent_concentration(strata.depth(a)), 1e-12);
    }
}

TEST(Strata, LevelWaysHaveTheConcentrationOfTheirDepth) {
    const Strata strata({0, 0, 0}, {0, 1, 0}, {1, 3}, {{0, {0, 4}}});
    for (const double tilt : {0.0, 1e-17, 1e-13, 1e-9}) {
        std::array<double, 1> column{};
        strata.add_column({0, -2, 0}, {3, -2 - tilt, 4}, column);
        EXPECT_NEAR(column[0], 10, 1e-8);
    }
}

TEST(Strata, BreaksAreWhereDepthsArePassed) {
    const Strata strata({0, 0, 0}, {0, 1, 0}, {1, 2, 5}, {{0, {0, 1, 1}}});
    std::vector<double> s;
    strata.append_breaks({{0, -0.5, 0}, {0.6, -0.8, 0}}, 3, s);
    ASSERT_EQ(s.size(), 2U);
    EXPECT_NEAR(s[0], 0.625, 1e-12);
    EXPECT_NEAR(s[1], 1.875, 1e-12);
    s.clear();
    strata.append_breaks({{0, -6, 0}, {0, 1, 0}}, 100, s);
    ASSERT_EQ(s.size(), 3U);  // ascending, though from below
    EXPECT_NEAR(s[0], 1, 1e-12);
    EXPECT_NEAR(s[2], 5, 1e-12);
    s.clear();
    strata.append_breaks({{0, -2, 0}, {1, 0, 0}}, 100, s);
    EXPECT_TRUE(s.empty());
}

}  // namespace
}  // namespace uw
