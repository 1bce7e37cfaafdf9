// ctest labels: unit
#include "cli/number_range.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(NumberRange, HasBothEndsUpToRounding) {
    const NumberRange up{0, 0.3, 0.1};  // 0.3 / 0.1 is less than 3 in binary
    EXPECT_EQ(up.count(), 4);
    EXPECT_EQ(up.at(0), 0);
    EXPECT_NEAR(up.at(3), 0.3, 1e-15);
    EXPECT_EQ((NumberRange{0, 0.35, 0.1}).count(), 4);
    EXPECT_EQ((NumberRange{5, 5, 1}).count(), 1);
}

TEST(NumberRange, GoesToItsLastWhateverTheSignOfTheStep) {
    for (const double step : {0.5, -0.5}) {
        const NumberRange down{2, 1, step};
        EXPECT_EQ(down.count(), 3);
        EXPECT_EQ(down.at(2), 1);
    }
}

TEST(NumberRange, IsThreeNumbersBetweenColons) {
    const auto range = number_range_in("-1.2:-0.2:1e-1");
    ASSERT_TRUE(range);
    EXPECT_EQ(range->first, -1.2);
    EXPECT_EQ(range->last, -0.2);
    EXPECT_EQ(range->step, 0.1);
    for (const char* const text : {"", "1", "1:2", "1:2:3:4", "1:2:", ":2:3", "1:x:3", "1:2: 3"})
        EXPECT_FALSE(number_range_in(text)) << text;
}

}  // namespace
}  // namespace uw
