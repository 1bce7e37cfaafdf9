// ctest labels: unit
#include "camera/lens_model.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace uw {
namespace {

constexpr double k_inverse_tolerance = 1e-10;  // what docs/physics.md promises

DistortionDesc brown_conrady(double k1, double k2, double p1, double p2, double k3) {
    DistortionDesc desc;
    desc.k = {k1, k2, k3, 0, 0, 0};
    desc.p = {p1, p2};
    return desc;
}

/// The largest error of undistort(distort(p)) over a grid of half width `reach`.
double worst_round_trip(const DistortionDesc& desc, double reach) {
    const Distortion distortion(desc);
    constexpr int k_steps = 20;
    double worst = 0;
    for (int i = -k_steps; i <= k_steps; ++i) {
        for (int j = -k_steps; j <= k_steps; ++j) {
            const NormalizedPoint p{reach * i / k_steps, reach * j / k_steps};
            const auto back = distortion.undistort(distortion.distort(p));
            if (!back) return std::numeric_limits<double>::infinity();
            worst = std::max(worst, std::hypot(back->x - p.x, back->y - p.y));
        }
    }
    return worst;
}

TEST(Distortion, FollowsTheFormulaOfOpenCv) {
    // Written out by hand for x = 0.3, y = -0.2, r^2 = 0.13.
    DistortionDesc desc = brown_conrady(-0.3, 0.1, 0.002, -0.001, 0.05);
    desc.k[3] = 0.02;
    desc.k[4] = -0.01;
    desc.k[5] = 0.004;
    const double r2 = 0.13;
    const double f = (1 - 0.3 * r2 + 0.1 * r2 * r2 + 0.05 * r2 * r2 * r2) /
                     (1 + 0.02 * r2 - 0.01 * r2 * r2 + 0.004 * r2 * r2 * r2);
    const double x = f * 0.3 + 2 * 0.002 * 0.3 * -0.2 - 0.001 * (r2 + 2 * 0.09);
    const double y = f * -0.2 + 0.002 * (r2 + 2 * 0.04) + 2 * -0.001 * 0.3 * -0.2;
    const NormalizedPoint shown = Distortion(desc).distort({0.3, -0.2});
    EXPECT_NEAR(shown.x, x, 1e-15);
    EXPECT_NEAR(shown.y, y, 1e-15);
}

TEST(Distortion, RoundTripBarrelPincushionAndRational) {
    EXPECT_LT(worst_round_trip(brown_conrady(-0.3, 0.12, 0.001, -0.0005, -0.02), 0.7),
              k_inverse_tolerance);
    EXPECT_LT(worst_round_trip(brown_conrady(0.4, 0.3, -0.002, 0.003, 0.1), 1.5),
              k_inverse_tolerance);
    DistortionDesc rational = brown_conrady(5.2, 3.1, 1e-4, -2e-4, 0.15);
    rational.k[3] = 5.5;
    rational.k[4] = 4.7;
    rational.k[5] = 0.7;
    EXPECT_LT(worst_round_trip(rational, 1.2), k_inverse_tolerance);
}

TEST(Distortion, NoDistortionIsTheIdentity) {
    const auto p = Distortion({}).undistort({1.25, -3.5});
    ASSERT_TRUE(p);
    EXPECT_EQ(p->x, 1.25);
    EXPECT_EQ(p->y, -3.5);
    EXPECT_TRUE(std::isinf(Distortion({}).fold_radius()));
}

TEST(Distortion, EmptyBeyondTheFold) {
    // r (1 - r^2/3) grows up to r = 1, where it is 2/3; nothing is shown farther out. Undamped
    // Newton would find the false preimage on the other side of the axis.
    const Distortion distortion(brown_conrady(-1.0 / 3, 0, 0, 0, 0));
    EXPECT_NEAR(distortion.fold_radius(), 1, 1e-12);
    for (int i = 0; i < 16; ++i) {
        const double angle = 0.4 * i;
        const double c = std::cos(angle), s = std::sin(angle);
        const auto before = distortion.undistort({0.6666 * c, 0.6666 * s});
        ASSERT_TRUE(before) << angle;
        const double r = std::hypot(before->x, before->y);
        EXPECT_LT(r, 1);
        EXPECT_NEAR(r - r * r * r / 3, 0.6666, 1e-12);
        for (const double beyond : {0.6667, 0.7, 1.0, 5.0, 1e6}) {
            EXPECT_FALSE(distortion.undistort({beyond * c, beyond * s})) << beyond << " " << angle;
        }
    }
}

TEST(Distortion, EmptyWhereTheModelFoldsAndUnfoldsAgain) {
    // d/dr [r (1 - r^2 + 0.25 r^4)] = (1 - r^2/2)(1 - 5 r^2/2): the model turns back at
    // r^2 = 0.4 (shown at 0.4048) and turns forth again at r^2 = 2. Places beyond 0.4048 have a
    // preimage with a positive definite Jacobian there, and no ray.
    const Distortion distortion(brown_conrady(-1, 0.25, 0, 0, 0));
    EXPECT_NEAR(distortion.fold_radius(), std::sqrt(0.4), 1e-12);
    EXPECT_TRUE(distortion.undistort({0.404, 0}));
    const NormalizedPoint unfolded = distortion.distort({2.5, 0});
    EXPECT_GT(unfolded.x, 0.41);
    EXPECT_FALSE(distortion.undistort(unfolded));
}

TEST(Distortion, EmptyBeyondAPoleIsNeverGarbage) {
    DistortionDesc desc;
    desc.k[3] = -1;  // f = 1 / (1 - r^2): everything out to infinity is shown from within r < 1
    const Distortion distortion(desc);
    EXPECT_NEAR(distortion.fold_radius(), 1, 1e-12);
    const auto p = distortion.undistort({100, 0});
    ASSERT_TRUE(p);
    EXPECT_LT(p->x, 1);
    EXPECT_NEAR(distortion.distort(*p).x, 100, 1e-6);  // the slope there is 2e4
}

TEST(Distortion, HostileNumbersGiveNoRay) {
    const double nan = std::nan("");
    const double huge = std::numeric_limits<double>::max();
    EXPECT_FALSE(Distortion({}).undistort({nan, 0}));
    EXPECT_FALSE(Distortion({}).undistort({0, std::numeric_limits<double>::infinity()}));
    EXPECT_FALSE(Distortion(brown_conrady(nan, 0, 0, 0, 0)).undistort({0.1, 0.1}));
    EXPECT_FALSE(Distortion(brown_conrady(huge, huge, 0, 0, -huge)).undistort({0.1, 0.1}));
    EXPECT_FALSE(Distortion(brown_conrady(0, 0, 100, -100, 0)).undistort({0.5, 0.5}));
}

}  // namespace
}  // namespace uw
