// ctest labels: unit analytic
#include "render/snow/snow_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace uw {
namespace {

struct Moments {
    double sum = 0, x = 0, y = 0, variance_x = 0, variance_y = 0, most = 0;
};

/// The moments of the pixels' fractions, taken at their centres.
Moments moments_of(const Footprint& footprint) {
    const PixelWindow& bounds = footprint.bounds();
    Grid2D<double> fractions(bounds.width(), bounds.height());
    footprint.add_fractions(bounds, fractions);
    Moments m;
    double xx = 0, yy = 0;
    for (int y = bounds.y0; y < bounds.y1; ++y)
        for (int x = bounds.x0; x < bounds.x1; ++x) {
            const double fraction = fractions(x - bounds.x0, y - bounds.y0);
            m.sum += fraction;
            m.x += fraction * (x + 0.5);
            m.y += fraction * (y + 0.5);
            xx += fraction * (x + 0.5) * (x + 0.5);
            yy += fraction * (y + 0.5) * (y + 0.5);
            m.most = std::max(m.most, fraction);
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

/// The fractions of a point that moves are the time that it spends in each pixel.
TEST(Footprint, APointThatMovesIsAsBrightAsItIsLongInAPixel) {
    Footprint::Path path{{10.5, 4.25}, {4, 0}, {}};  // from 6.5 to 14.5
    const Footprint footprint(path, circle(1e-4), {});
    Grid2D<double> fractions(20, 10);
    footprint.add_fractions({0, 0, 20, 10}, fractions);
    for (int x = 0; x < 20; ++x) {
        const double expected = x < 6 || x > 14 ? 0 : (x == 6 || x == 14 ? 0.5 : 1) / 8.0;
        EXPECT_NEAR(fractions(x, 4), expected, 1e-4) << x;
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

/// What a disk covers of a pixel, by counting points of the pixel.
double covered(double x, double y, double at_x, double at_y, double radius) {
    if (std::hypot(x + 0.5 - at_x, y + 0.5 - at_y) > radius + 0.71) return 0;
    constexpr int k_steps = 100;
    int count = 0;
    for (int j = 0; j < k_steps; ++j)
        for (int i = 0; i < k_steps; ++i)
            count +=
                std::hypot(x + (i + 0.5) / k_steps - at_x, y + (j + 0.5) / k_steps - at_y) < radius;
    return count / double(k_steps * k_steps);
}

/// A flake is a disk, however small and wherever it lies in a pixel: each pixel has the fraction of
/// its light that it covers of the disk.
TEST(Footprint, EachPixelHasWhatItCoversOfTheDisk) {
    for (const double radius : {0.05, 0.2, 0.45, 0.69, 0.75, 1.3, 2.4, 5.0})
        for (const auto& [at_x, at_y] : std::vector<std::pair<double, double>>{
                 {8.5, 8.5}, {8.0, 8.0}, {8.1, 8.35}, {8.93, 8.07}, {8.71, 8.5}}) {
            const Footprint footprint({{at_x, at_y}, {}, {}}, circle(radius), {});
            Grid2D<double> fractions(17, 17);
            footprint.add_fractions({0, 0, 17, 17}, fractions);
            const double area = std::numbers::pi * radius * radius;
            double sum = 0;
            for (int y = 0; y < 17; ++y)
                for (int x = 0; x < 17; ++x) {
                    // A count along an edge of up to 1.4 pixels is off by less than a hundredth of
                    // it, mostly by far less.
                    EXPECT_NEAR(area * fractions(x, y), covered(x, y, at_x, at_y, radius), 2e-3)
                        << radius << " " << x << " " << y;
                    sum += fractions(x, y);
                }
            EXPECT_NEAR(sum, 1, 1e-9);
        }
}

/// Seen at all places of a pixel, a flake is as wide in all directions: its second moments about
/// its place are r^2/4 of the disk and 1/12 of the pixel along x, y and both diagonals.
TEST(Footprint, IsAsWideInAllDirections) {
    constexpr int k_places = 16;
    for (const double radius : {0.05, 0.3, 0.65, 0.8, 1.7, 4.0})
        for (const double blur : {0.0, 0.1, 0.24}) {
            double xx = 0, xy = 0, yy = 0;
            for (int j = 0; j < k_places; ++j)
                for (int i = 0; i < k_places; ++i) {
                    const double at_x = 8 + (i + 0.5) / k_places, at_y = 8 + (j + 0.5) / k_places;
                    const Footprint footprint({{at_x, at_y}, {}, {}}, circle(radius), circle(blur));
                    Grid2D<double> fractions(17, 17);
                    footprint.add_fractions({0, 0, 17, 17}, fractions);
                    for (int y = 0; y < 17; ++y)
                        for (int x = 0; x < 17; ++x) {
                            const double u = x + 0.5 - at_x, v = y + 0.5 - at_y;
                            const double fraction = fractions(x, y) / (k_places * k_places);
                            xx += fraction * u * u;
                            xy += fraction * u * v;
                            yy += fraction * v * v;
                        }
                }
            const double expected = (radius * radius + blur * blur) / 4 + 1.0 / 12;
            // The sum over places stands for an integral: exact for a point to 1/12 of the square
            // of their distance.
            const double tolerance = 1e-3 * expected + 1.0 / (12 * k_places * k_places);
            EXPECT_NEAR(xx, expected, tolerance) << radius;
            EXPECT_NEAR(yy, expected, tolerance) << radius;
            EXPECT_NEAR(0.5 * (xx + yy) + xy, expected, tolerance) << radius;  // along x = y
            EXPECT_NEAR(0.5 * (xx + yy) - xy, expected, tolerance) << radius;
        }
}

/// The part of a window is that of the whole.
TEST(Footprint, PartsArePartsOfTheWhole) {
    for (const double disk : {0.3, 3.0}) {
        Footprint::Path path = k_still;
        path.linear = {9, -5};
        path.quadratic = {2, 1};
        const Footprint footprint(path, circle(disk), circle(0.5));
        Grid2D<double> whole(40, 40), part(7, 5);
        footprint.add_fractions({0, 0, 40, 40}, whole);
        footprint.add_fractions({15, 14, 22, 19}, part);
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
    Grid2D<double> fractions(around.width(), around.height());
    footprint.add_fractions(around, fractions);
    double sum = 0;
    for (const double fraction : fractions) sum += fraction;
    EXPECT_NEAR(sum * 4096, 1, 1e-9);
}

}  // namespace
}  // namespace uw
