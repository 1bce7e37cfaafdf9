// ctest labels: unit
#include "core/base/numerics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace uw::test {
namespace {

TEST(ExpOfMinus, EqualsTheLibrarysToOneInTenToTheEleven) {
    double worst = 0;
    for (double x = 0; x < 700; x += 0.00173)
        worst = std::max(worst, std::abs(exp_of_minus(x) / std::exp(-x) - 1));
    EXPECT_LT(worst, 1e-11);  // (ln 2 / 2)^10 / 10! = 7e-12, and rounding
}

TEST(ExpOfMinus, IsOneAtZeroAndZeroAtInfinity) {
    EXPECT_EQ(exp_of_minus(0), 1);
    EXPECT_EQ(exp_of_minus(701), 0);
    EXPECT_EQ(exp_of_minus(1e300), 0);
    EXPECT_EQ(exp_of_minus(std::numeric_limits<double>::infinity()), 0);
    EXPECT_GT(exp_of_minus(699), 0);
}

}  // namespace
}  // namespace uw::test
