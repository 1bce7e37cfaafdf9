// ctest labels: unit analytic
#include "media/water/henyey_greenstein.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "tests/support/described_phase.h"
#include "tests/support/phase_function_laws.h"
#include "tests/support/phase_test_values.h"

namespace uw {
namespace {

TEST(HenyeyGreenstein, ObeysTheLaws) {
    for (const double g : {-0.99, -0.6, 0.0, 0.3, 0.9, 0.924, 0.999})
        test::expect_phase_function_laws(HenyeyGreenstein(g), g);
}

TEST(HenyeyGreenstein, MatchesTheTestValues) {
    test::expect_phase_column(*test::henyey_greenstein(0.924),
                              test::phase_test_table("phase_function_test_values.csv"), "HG_0p924");
}

// The first split is as far from the peak as the pole of p from the real axis; the others follow at
// ratios of 3, up to a right angle.
TEST(HenyeyGreenstein, IsSplitAwayFromItsPeak) {
    for (const double g : {0.6, 0.9, 0.99}) {
        const std::vector<double> splits = test::henyey_greenstein(g)->breakpoints();
        ASSERT_FALSE(splits.empty());
        EXPECT_NEAR(splits.front(), std::log(1 / g), 1e-15);
        for (std::size_t i = 1; i < splits.size(); ++i)
            EXPECT_NEAR(splits[i] / splits[i - 1], 3, 1e-12);
        EXPECT_LT(splits.back(), std::numbers::pi / 2);
        EXPECT_GE(3 * splits.back(), std::numbers::pi / 2);
        std::vector<double> mirrored = test::henyey_greenstein(-g)->breakpoints();
        ASSERT_EQ(mirrored.size(), splits.size());
        for (std::size_t i = 0; i < splits.size(); ++i)
            EXPECT_NEAR(mirrored[splits.size() - 1 - i], std::numbers::pi - splits[i], 1e-15);
    }
    EXPECT_TRUE(test::henyey_greenstein(0.49)->breakpoints().empty());
}

TEST(HenyeyGreenstein, RefusesImpossibleParameters) {
    for (const double g : {-1.0, 1.0, 2.0, std::nan("")})
        EXPECT_THROW(test::henyey_greenstein(g), InputError);
}

}  // namespace
}  // namespace uw
