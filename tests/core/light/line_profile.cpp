// ctest labels: unit analytic
#include "core/light/line_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/base/numerics.h"
#include "tests/support/lamp_profile_laws.h"
#include "tests/support/random_direction.h"

namespace uw::test {
namespace {

constexpr double k_line_degree = std::numbers::pi / 180;

TEST(LineProfile, ObeysTheLaws) {
    expect_lamp_profile_laws(LineProfile({60, 2, 0}, {}));
    expect_lamp_profile_laws(LineProfile({170, 20, -30}, {}));
    expect_lamp_profile_laws(LineProfile({0.5, 10, 75}, {}));
}

TEST(LineProfile, IsAGaussianAcrossItsPlane) {
    const LineProfile line({60, 2, 0}, {});
    const auto at = [&](double along, double off) {
        const double x = along * k_line_degree, y = off * k_line_degree;
        return line.relative_intensity(
            {std::sin(x) * std::cos(y), std::sin(y), std::cos(x) * std::cos(y)});
    };
    for (const double along : {-29.9, 0.0, 29.9}) {
        EXPECT_NEAR(at(along, 0), 1, 1e-12);
        EXPECT_NEAR(at(along, 1), 0.5, 1e-12);
        EXPECT_NEAR(at(along, -2), 1.0 / 16, 1e-12);
        EXPECT_EQ(at(along, 4.001), 0);
    }
    EXPECT_EQ(at(30.1, 0), 0);
    EXPECT_EQ(at(180, 0), 0);
}

// From behind the lamp, with x to the right and y down as a camera has them.
TEST(LineProfile, TurnsAnticlockwise) {
    const LineProfile line({60, 1, 30}, {});
    EXPECT_NEAR(
        line.relative_intensity({std::cos(30 * k_line_degree), -std::sin(30 * k_line_degree), 5}),
        1, 1e-12);
    EXPECT_EQ(
        line.relative_intensity({std::cos(30 * k_line_degree), std::sin(30 * k_line_degree), 5}),
        0);
}

TEST(LineProfile, SolidAngleIsTheIntegral) {
    // The sheet is 40 steps wide, and its ends lie between steps.
    const LineProfile line({61, 20, 12}, {});
    EXPECT_NEAR(line.solid_angle() / solid_angle_by_quadrature(line, 2000, 4000), 1, 2e-4);
    // A narrow one is flat: the Gaussian's integral times the fan's angle.
    const double width = 0.05 * k_line_degree;
    EXPECT_NEAR(LineProfile({90, 0.05, 0}, {}).solid_angle(),
                90 * k_line_degree * width * std::sqrt(std::numbers::pi / (4 * std::numbers::ln2)),
                1e-5 * width);
}

// What the breaks are for: few nodes between two of them integrate the light along a ray. The beam
// has all of it.
TEST(LineProfile, FewNodesBetweenBreaksIntegrateIt) {
    const LineProfile line({80, 0.3, 20}, {});
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> offset(-0.5, 0.5);
    int crossings = 0;
    for (int n = 0; n < 2000; ++n) {
        const Ray ray{{offset(rng), offset(rng), offset(rng) + 2}, random_direction(rng)};
        const Interval whole{0, 6};
        std::vector<double> s{whole.begin, whole.end};
        line.append_breaks(ray, whole, {0, 0, 0}, s);
        std::erase_if(s, [&](double at) { return at < whole.begin || at > whole.end; });
        std::sort(s.begin(), s.end());
        const auto at = [&](double t) { return line.relative_intensity(from_origin(ray.at(t))); };
        double sum = 0;
        for (std::size_t i = 0; i + 1 < s.size(); ++i)
            for (const QuadratureNode& node : gauss_legendre(4))
                sum +=
                    node.weight * (s[i + 1] - s[i]) * at(s[i] + node.position * (s[i + 1] - s[i]));
        const Interval lit = line.beam(ray, whole, {0, 0, 0});
        constexpr int k_midpoints = 4000;
        double fine = 0;
        for (int i = 0; i < k_midpoints; ++i)
            fine +=
                at(lit.begin + (i + 0.5) / k_midpoints * lit.length()) * lit.length() / k_midpoints;
        // A ray that leaves the sheet through one of its ends cuts a step of the midpoint rule.
        EXPECT_NEAR(sum, fine, 2e-3 * fine + 1e-9) << n;
        for (double t = 0.003; t < 6; t += 0.01)
            if (t < lit.begin || t > lit.end) {
                EXPECT_EQ(at(t), 0);
            }
        crossings += fine > 0 ? 1 : 0;
    }
    EXPECT_GT(crossings, 500);
}

}  // namespace
}  // namespace uw::test
