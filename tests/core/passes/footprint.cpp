// ctest labels: unit analytic
#include "core/passes/snow_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace uw {
namespace {

struct Moments {
    double sum = 0, x = 0, y = 0, variance_x = 0, variance_y = 0, most = 0;
};

/// The moments of the pixels' shares, taken at their centres.
Moments moments_of(const Footprint& footprint) {
    const PixelWindow& bounds = footprint.bounds();
    Grid2D<double> shares(bounds.width(), bounds.height());
    footprint.add_shares(bounds, shares);
    Moments m;
    double xx = 0, yy = 0;
    for (int y = bounds.y0; y < bounds.y1; ++y)
        for (int x = bounds.x0; x < bounds.x1; ++x) {
            const double share = shares(x - bounds.x0, y - bounds.y0);
            m.sum += share;
            m.x += share * (x + 0.5);
            m.y += share * (y + 0.5);
            xx += share * (x + 0.5) * (x + 0.5);
            yy += share * (y + 0.5) * (y + 0.5);
            m.most = std::max(m.most, share);
        }
    m.x /= m.sum;
    m.y /= m.sum;
    m.variance_x = xx / m.sum - m.x * m.x;
    m.variance_y = yy / m.sum - m.y * m.y;
    return m;
}

PlaneMap circle(double radius) {
    return {radius, 0, 0, radius};
}

constexpr Footprint::Path k_still{{20.3, 17.8}, {}, {}};

/// What is sampled misses its edge by less than 1 % of its light if it is large; else all light is
/// there, to rounding.
TEST(Footprint, NoLightIsLost) {
    for (const double disk : {0.001, 0.1, 0.4, 0.8, 3.0, 9.0, 40.0})
        for (const double blur : {0.0, 0.3, 1.0, 5.0, 30.0})
            for (const double streak : {0.0, 0.7, 25.0}) {
                Footprint::Path path = k_still;
                path.linear = {streak, 0.4 * streak};
                const Footprint footprint(path, circle(disk), circle(blur));
                const bool is_large = std::hypot(disk, blur) >= 16;
                const double tolerance = is_large ? 0.01 : 1e-9;
                EXPECT_NEAR(moments_of(footprint).sum, 1, tolerance)
                    << disk << " " << blur << " " << streak;
                EXPECT_NEAR(footprint.area(), std::numbers::pi * disk * disk, 1e-9 * disk * disk);
            }
}

/// A disk's variance along an axis is r^2/4, those of disk, blur, movement and pixel (1/12) add up.
/// What is smaller than a pixel lands in the pixels that it touches, so that its own place in them
/// is lost.
TEST(Footprint, VariancesAddUp) {
    for (const double disk : {1.5, 4.0, 12.0})
        for (const double blur : {0.0, 2.0, 7.0})
            for (const double half : {0.0, 6.0, 30.0}) {
                Footprint::Path path = k_still;
                path.linear = {half, 0};
                const Moments m = moments_of(Footprint(path, circle(disk), circle(blur)));
                const double still = 0.25 * (disk * disk + blur * blur) + 1.0 / 12;
                // Samples of a disk's edge move its centre by some hundredths of a pixel; steps of
                // its movement are a quarter of its radius, or half a pixel. Soft edges are sampled
                // once per pixel, at its centre.
                EXPECT_NEAR(m.x, 20.3, 0.06);
                EXPECT_NEAR(m.y, 17.8, 0.06);
                EXPECT_NEAR(m.variance_x, still + half * half / 3, 0.05 * still + 1.0 / 12);
                EXPECT_NEAR(m.variance_y, still, 0.05 * still + 1.0 / 12);
            }
}

/// The shares of a point that moves are the time that it spends in each pixel.
TEST(Footprint, APointThatMovesIsAsBrightAsItIsLongInAPixel) {
    Footprint::Path path{{10.5, 4.25}, {4, 0}, {}};  // from 6.5 to 14.5
    const Footprint footprint(path, circle(1e-4), {});
    Grid2D<double> shares(20, 10);
    footprint.add_shares({0, 0, 20, 10}, shares);
    for (int x = 0; x < 20; ++x) {
        const double expected = x < 6 || x > 14 ? 0 : (x == 6 || x == 14 ? 0.5 : 1) / 8.0;
        EXPECT_NEAR(shares(x, 4), expected, 1e-4) << x;
    }
}

TEST(Footprint, WhatIsInOnePixelStaysThere) {
    const Moments m = moments_of(Footprint({{3.4, 5.6}, {}, {}}, circle(0.2), {}));
    EXPECT_NEAR(m.most, 1, 1e-12);
}

/// A sharp disk covers what it covers and no more.
TEST(Footprint, ASharpDiskCoversItsPixelsOnce) {
    const Footprint footprint(k_still, circle(10), {});
    EXPECT_NEAR(footprint.area() * moments_of(footprint).most, 1, 5e-3);
}

/// The part of a window is that of the whole.
TEST(Footprint, PartsArePartsOfTheWhole) {
    for (const double disk : {0.3, 3.0}) {
        Footprint::Path path = k_still;
        path.linear = {9, -5};
        path.quadratic = {2, 1};
        const Footprint footprint(path, circle(disk), circle(0.5));
        Grid2D<double> whole(40, 40), part(7, 5);
        footprint.add_shares({0, 0, 40, 40}, whole);
        footprint.add_shares({15, 14, 22, 19}, part);
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 7; ++x) EXPECT_EQ(part(x, y), whole(15 + x, 14 + y));
    }
}

/// Most of it is outside the image: a streak of a million pixels takes the memory of its disk.
TEST(Footprint, OfALongStreakIsDrawnStepByStep) {
    Footprint::Path path = k_still;
    path.linear = {1e6, -1e6};
    const Footprint footprint(path, circle(3), circle(1));
    // The middle two of its 4096 steps, which is as many as there are.
    const double aside = 1e6 / 4096;
    const PixelWindow around{static_cast<int>(20.3 - aside) - 9, static_cast<int>(17.8 + aside) - 9,
                             static_cast<int>(20.3 - aside) + 9,
                             static_cast<int>(17.8 + aside) + 9};
    Grid2D<double> shares(around.width(), around.height());
    footprint.add_shares(around, shares);
    double sum = 0;
    for (const double share : shares) sum += share;
    EXPECT_NEAR(sum * 4096, 1, 1e-9);
}

}  // namespace
}  // namespace uw
