// ctest labels: unit analytic
#include <gtest/gtest.h>

#include "core/paths/radiance_nodes.h"

namespace uw {
namespace {

/// Two parts side by side in an image of 40 x 10 pixels; their centres are at x = 10 and 30.
NodePaths two_parts() {
    Grid2D<NodePaths::Part> parts(2, 1);
    parts(0, 0) = {.numbers = {.surface = 8, .lit = 100, .water = 20}, .estimated_water = 1};
    parts(1, 0) = {.numbers = {.surface = 16, .lit = 300, .water = 40}, .estimated_water = 3};
    return {parts, 40, 10};
}

TEST(NodePaths, AreLinearBetweenTheCentresOfParts) {
    const NodePaths paths = two_parts();
    const RadianceNode dark;
    for (const double y : {0.0, 7.0, 10.0}) {
        EXPECT_DOUBLE_EQ(paths.of(dark, 0, y).lit, 100);
        EXPECT_DOUBLE_EQ(paths.of(dark, 10, y).lit, 100);
        EXPECT_DOUBLE_EQ(paths.of(dark, 15, y).lit, 150);
        EXPECT_DOUBLE_EQ(paths.of(dark, 15, y).water, 25);
        EXPECT_DOUBLE_EQ(paths.of(dark, 15, y).surface, 10);
        EXPECT_DOUBLE_EQ(paths.of(dark, 40, y).lit, 300);
    }
    EXPECT_DOUBLE_EQ(paths.mean().surface, 12);
    EXPECT_DOUBLE_EQ(paths.mean().lit, 200);
    EXPECT_DOUBLE_EQ(paths.mean().water, 30);
}

TEST(NodePaths, AreMoreWhereANodeIsBrighterThanItsPart) {
    const NodePaths paths = two_parts();
    RadianceNode bright;
    bright.estimated_water = 8;
    bright.estimated_surface = 1e6;
    // 8 / 2 at half the way.
    EXPECT_DOUBLE_EQ(paths.of(bright, 20, 5).lit, 4 * 200);
    EXPECT_DOUBLE_EQ(paths.of(bright, 20, 5).water, 4 * 30);
    // What a part does not know changes nothing.
    EXPECT_DOUBLE_EQ(paths.of(bright, 20, 5).surface, 12);
    EXPECT_DOUBLE_EQ(NodePaths({.surface = 7, .lit = 8, .water = 9}).of(bright, 3, 3).water, 9);
}

}  // namespace
}  // namespace uw
