// ctest labels: unit
#include "cli/runs/sweep_command.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using Values = std::vector<double>;

TEST(SweepAxis, HasBothEndsAndDecimalValues) {
    const auto axis = sweep_axis("lamps.left.position[0]=-1.2:-0.2:0.2");
    ASSERT_TRUE(axis);
    EXPECT_EQ(axis->key, "lamps.left.position[0]");
    EXPECT_EQ(axis->values, (Values{-1.2, -1, -0.8, -0.6, -0.4, -0.2}));
    EXPECT_EQ(axis->override_at(1), "lamps.left.position[0]=-1");
    EXPECT_EQ(sweep_axis("a=0:0.35:0.1")->values, (Values{0, 0.1, 0.2, 0.3}));
}

TEST(SweepAxis, RunsDownIfItsEndIsLess) {
    EXPECT_EQ(sweep_axis("a=1.2:1:0.1")->values, (Values{1.2, 1.1, 1}));
    EXPECT_EQ(sweep_axis("a=1.2:1:-0.1")->values, (Values{1.2, 1.1, 1}));
}

TEST(SweepAxis, IsNoneOfOtherValues) {
    for (const char* text : {"a=1", "a=[1, 2]", "a=1:2", "a=1:2:3:4", "a=x:1:2", "a=c:/file:1",
                             "water.preset=jerlov-II", "a"})
        EXPECT_FALSE(sweep_axis(text)) << text;
}

TEST(SweepAxis, RefusesRangesWithoutSense) {
    const auto message = [](const char* text) {
        return test::message_of<UsageError>([&] { sweep_axis(text); });
    };
    EXPECT_NE(message("a=0:1:0").find("the step is 0"), std::string::npos);
    EXPECT_NE(message("a=0:1:2").find("larger than the range"), std::string::npos);
    EXPECT_NE(message("a=0:1:1e-6").find("more than 1000 values"), std::string::npos);
}

}  // namespace
}  // namespace uw
