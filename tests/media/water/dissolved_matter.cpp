// ctest labels: unit analytic
#include "media/water/water_types.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uw {
namespace {

TEST(DissolvedMatter, CdomByHand) {
    EXPECT_DOUBLE_EQ(cdom_absorption(440, 0.3), 0.3);
    EXPECT_NEAR(cdom_absorption(540, 0.3), 0.3 * std::exp(-1.4), 1e-15);
    EXPECT_EQ(cdom_absorption(540, 0), 0);
}

// Rows of Bricaud's table: at 1 mg/m^3 the factor itself, at others the power 1 - B.
TEST(DissolvedMatter, ChlorophyllFollowsTheTable) {
    EXPECT_DOUBLE_EQ(chlorophyll_absorption(440, 1), 0.0403);
    EXPECT_NEAR(chlorophyll_absorption(440, 10), 0.0403 * std::pow(10, 1 - 0.332), 1e-12);
    EXPECT_NEAR(chlorophyll_absorption(442.5, 1), 0.5 * (0.0403 + 0.03865), 1e-12);
    EXPECT_EQ(chlorophyll_absorption(440, 0), 0);
    EXPECT_DOUBLE_EQ(chlorophyll_absorption_range().first_nm, 400);
    EXPECT_DOUBLE_EQ(chlorophyll_absorption_range().last_nm, 700);
    EXPECT_DOUBLE_EQ(chlorophyll_absorption(350, 1), chlorophyll_absorption(400, 1));
    EXPECT_DOUBLE_EQ(chlorophyll_absorption(750, 1), chlorophyll_absorption(700, 1));
}

}  // namespace
}  // namespace uw
