// ctest labels: unit
#include "cli/pages/svg_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace uw {
namespace {

std::string labels(const AxisTicks& axis) {
    std::string text;
    for (const AxisTick& tick : axis.ticks)
        if (!tick.label.empty()) text += (text.empty() ? "" : " ") + tick.label;
    return text;
}

AxisRequest request(AxisScale scale) {
    AxisRequest r;
    r.scale = scale;
    return r;
}

TEST(PlotTicks, LinearAxesEndOnRoundNumbers) {
    const std::vector<double> values{403, 697, 512};
    const AxisTicks axis = choose_ticks(request(AxisScale::linear), values);
    EXPECT_EQ(axis.min, 400);
    EXPECT_EQ(axis.max, 700);
    EXPECT_EQ(labels(axis), "400 450 500 550 600 650 700");
    EXPECT_EQ(labels(choose_ticks(request(AxisScale::linear), std::vector<double>{-0.3, 0.62})),
              "-0.4 -0.2 0 0.2 0.4 0.6 0.8");
}

TEST(PlotTicks, LimitsAndStepsAskedForAreKept) {
    AxisRequest r = request(AxisScale::linear);
    r.min = 0;
    r.max = 180;
    r.tick_step = 30;
    const AxisTicks axis = choose_ticks(r, std::vector<double>{5, 900});
    EXPECT_EQ(axis.max, 180);
    EXPECT_EQ(labels(axis), "0 30 60 90 120 150 180");
    r = request(AxisScale::log);
    r.min = 0.1;
    r.max = 180;
    EXPECT_EQ(labels(choose_ticks(r, {})), "0.1 1 10 100");
    r = request(AxisScale::linear);
    r.min = 0;
    r.max = 1;
    r.tick_step = 0.25;
    EXPECT_EQ(labels(choose_ticks(r, {})), "0 0.25 0.50 0.75 1.00");
}

TEST(PlotTicks, LogAxesEndOnPowersOfTen) {
    const AxisTicks axis = choose_ticks(request(AxisScale::log), std::vector<double>{3e-5, 40});
    EXPECT_NEAR(axis.min, 1e-5, 1e-17);
    EXPECT_NEAR(axis.max, 100, 1e-10);
    EXPECT_EQ(labels(axis), "10⁻⁵ 10⁻⁴ 10⁻³ 10⁻² 10⁻¹ 10⁰ 10¹ 10²");
    EXPECT_EQ(axis.ticks.size(), 8U + 7U * 8U);  // and minor ones at 2 to 9
    EXPECT_EQ(labels(choose_ticks(request(AxisScale::log), std::vector<double>{8, 512})),
              "1 10 100 1000");
    // Two decades or fewer have labels in between
    EXPECT_EQ(labels(choose_ticks(request(AxisScale::log), std::vector<double>{2e-4, 7e-4})),
              "10⁻⁴ 2·10⁻⁴ 5·10⁻⁴ 10⁻³");
    // Many decades do not crowd
    const AxisTicks wide = choose_ticks(request(AxisScale::log), std::vector<double>{1e-30, 1e20});
    EXPECT_EQ(labels(wide), "10⁻³⁰ 10⁻²³ 10⁻¹⁶ 10⁻⁹ 10⁻² 10⁵ 10¹² 10¹⁹");
}

// Whatever the data: a range of positive length, ticks inside it in ascending order, and not so
// many labels that they overlap.
TEST(PlotTicks, AnyData) {
    const double inf = std::numeric_limits<double>::infinity();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::vector<double>> cases{{},
                                                 {nan, inf},
                                                 {0},
                                                 {5, 5},
                                                 {-3, -3},
                                                 {1e-300, 1},
                                                 {1e300},
                                                 {-1e8, 1e-8},
                                                 {1, 1.0001},
                                                 {1e-12, 2e-12},
                                                 {0, 1e7, -inf},
                                                 {nan, 3, 4},
                                                 {1e9 + 1, 1e9 + 2, 1e9 + 3},
                                                 {std::numeric_limits<double>::denorm_min()}};
    for (const AxisScale scale : {AxisScale::linear, AxisScale::log})
        for (const std::vector<double>& values : cases) {
            const AxisTicks axis = choose_ticks(request(scale), values);
            ASSERT_TRUE(std::isfinite(axis.min) && std::isfinite(axis.max));
            EXPECT_LT(axis.min, axis.max);
            if (scale == AxisScale::log) {
                EXPECT_GT(axis.min, 0);
            }
            int labelled = 0;
            for (std::size_t i = 0; i < axis.ticks.size(); ++i) {
                EXPECT_GE(axis.ticks[i].value, axis.min);
                EXPECT_LE(axis.ticks[i].value, axis.max);
                if (i > 0) {
                    EXPECT_LT(axis.ticks[i - 1].value, axis.ticks[i].value);
                }
                labelled += axis.ticks[i].label.empty() ? 0 : 1;
            }
            EXPECT_GE(labelled, 2);
            EXPECT_LE(labelled, 10);
        }
}

}  // namespace
}  // namespace uw
