// ctest labels: unit analytic
#include "core/base/csv_table.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(SampledCurve, PassesThroughItsSamples) {
    const SampledCurve curve{{400, 410, 500}, {1, -2, 7}};
    for (std::size_t i = 0; i < curve.x.size(); ++i) EXPECT_EQ(curve.value(curve.x[i]), curve.y[i]);
}

TEST(SampledCurve, IsALineBetweenThem) {
    const SampledCurve line{{0, 1, 5, 7}, {3, 5, 13, 17}};  // 3 + 2 x
    for (double x = 0; x <= 7; x += 0.37) EXPECT_NEAR(line.value(x), 3 + 2 * x, 1e-14);
}

TEST(SampledCurve, HoldsItsEnds) {
    const SampledCurve curve{{400, 700}, {0.25, 4}};
    EXPECT_EQ(curve.value(399), 0.25);
    EXPECT_EQ(curve.value(-1e300), 0.25);
    EXPECT_EQ(curve.value(701), 4);
    EXPECT_EQ(curve.first(), 400);
    EXPECT_EQ(curve.last(), 700);
    EXPECT_TRUE(curve.covers(400) && curve.covers(700) && curve.covers(555));
    EXPECT_FALSE(curve.covers(399.999) || curve.covers(700.001));
}

TEST(SampledCurve, OfOneSampleIsConstant) {
    const SampledCurve constant{{550}, {3}};
    for (const double x : {0.0, 550.0, 1000.0}) EXPECT_EQ(constant.value(x), 3);
}

}  // namespace
}  // namespace uw
