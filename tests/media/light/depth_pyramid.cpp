// ctest labels: unit
#include "media/light/shadow_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace uw {
namespace {

constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// Corners of `cells` times `cells` cells: most at random depths, some at none, some not traced.
Grid2D<float> random_depths(int cells) {
    Grid2D<float> samples(cells + 1, cells + 1);
    std::mt19937 random(7);
    for (int v = 0; v <= cells; ++v)
        for (int u = 0; u <= cells; ++u) {
            const auto drawn = static_cast<float>(random() % 1000);
            samples(u, v) = drawn < 20   ? DepthPyramid::k_untraced
                            : drawn < 40 ? k_infinity
                                         : 1 + drawn / 100;
        }
    return samples;
}

/// Over the cells from (u0, v0) up to, but excluding, (u1, v1), one by one.
DepthRange range_of(const Grid2D<float>& samples, int u0, int v0, int u1, int v1) {
    DepthRange range{k_infinity, 0};
    for (int v = v0; v < std::min(v1, samples.height() - 1); ++v)
        for (int u = u0; u < std::min(u1, samples.width() - 1); ++u) {
            const auto corners = {samples(u, v), samples(u + 1, v), samples(u, v + 1),
                                  samples(u + 1, v + 1)};
            if (std::min(corners) == DepthPyramid::k_untraced) continue;
            range.nearest = std::min(range.nearest, std::min(corners));
            range.farthest = std::max(range.farthest, std::max(corners));
        }
    return range;
}

// At most two by two squares of 1, 2, 4... cells cover the cells that are asked for: bounds are
// those of their depths and of no others.
TEST(DepthPyramid, BoundsAreThoseOfTheSquaresAroundTheCells) {
    for (const int cells : {1, 2, 5, 16}) {
        const Grid2D<float> samples = random_depths(cells);
        const DepthPyramid pyramid(samples);
        for (int v0 = 0; v0 < cells; ++v0)
            for (int u0 = 0; u0 < cells; ++u0)
                for (int v1 = v0; v1 < cells; ++v1)
                    for (int u1 = u0; u1 < cells; ++u1) {
                        int side = 1;
                        while (u1 / side - u0 / side > 1 || v1 / side - v0 / side > 1) side *= 2;
                        const DepthRange truth =
                            range_of(samples, u0 / side * side, v0 / side * side,
                                     (u1 / side + 1) * side, (v1 / side + 1) * side);
                        const DepthRange found = pyramid.bound(u0, v0, u1, v1);
                        ASSERT_EQ(found.nearest, truth.nearest) << u0 << ' ' << v0 << ' ' << u1;
                        ASSERT_EQ(found.farthest, truth.farthest) << u0 << ' ' << v0 << ' ' << u1;
                    }
    }
}

}  // namespace
}  // namespace uw
