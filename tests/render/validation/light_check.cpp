// ctest labels: unit
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/validation/light_trial.h"

namespace uw::test {
namespace {

LightCheck check_of(double deviation, double error) {
    return {"left", "right", "light", deviation, error, 0.01};
}

TEST(LightChecks, PassWithinTheirErrors) {
    EXPECT_TRUE(check_of(0.0039, 0.001).passed());
    EXPECT_TRUE(check_of(-0.0039, 0.001).passed());
    EXPECT_FALSE(check_of(0.0041, 0.001).passed());
    EXPECT_FALSE(check_of(-0.0041, 0.001).passed());
    EXPECT_TRUE(check_of(0, 0).passed());
    EXPECT_FALSE(check_of(1e-9, 0).passed());
}

TEST(LightChecks, FailWhereNoiseOrNaNHidesWhatTheyCheck) {
    EXPECT_FALSE(check_of(0, 0.011).passed());
    EXPECT_FALSE(check_of(std::nan(""), 0.001).passed());
    EXPECT_FALSE(check_of(0, std::nan("")).passed());
    EXPECT_FALSE(check_of(0, std::numeric_limits<double>::infinity()).passed());
}

TEST(LightChecks, FailWherePixelsAreNoisierThanStated) {
    LightCheck check = check_of(0, 0.001);
    check.spread = PixelSpread{96, 0.01, 1.9, 5};
    EXPECT_TRUE(check.passed());
    check.spread->rms_in_errors = 2.1;
    EXPECT_FALSE(check.passed());
    check.spread->rms_in_errors = std::nan("");
    EXPECT_FALSE(check.passed());
}

TEST(LightParts, SayHowMuchSingleScatteringLeavesOut) {
    const LightParts parts{{1, 2, 3, 6}};
    EXPECT_EQ(parts.all(), 12);
    EXPECT_EQ(parts.fraction(3), 0.5);
    EXPECT_EQ(parts.ratio(), 4);
    EXPECT_EQ(LightParts{}.fraction(0), 0);
    EXPECT_EQ(LightParts{}.ratio(), 0);
}

TEST(LightMean, KnowsItsStandardError) {
    LightMean mean;
    EXPECT_EQ(mean.error(), 0);
    for (const double estimate : {1.0, 2.0, 3.0, 6.0}) mean.add(estimate);
    EXPECT_DOUBLE_EQ(mean.mean(), 3);
    EXPECT_DOUBLE_EQ(mean.error(), std::sqrt(14.0 / 3 / 4));
}

}  // namespace
}  // namespace uw::test
