// ctest labels: unit
#include "core/scene/yaml_document.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

namespace uw {
namespace {

TEST(NumberText, IsWhatAPersonWrites) {
    EXPECT_EQ(number_text(0.25), "0.25");
    EXPECT_EQ(number_text(-0.0), "0");
    EXPECT_EQ(number_text(12), "12");
    EXPECT_EQ(number_text(0.1), "0.1");
    EXPECT_EQ(number_text(1400), "1400");
    EXPECT_EQ(number_text(0.00002), "0.00002");
    EXPECT_EQ(number_text(1e-9), "1e-9");
    EXPECT_EQ(number_text(-2.5e20), "-2.5e+20");
    EXPECT_EQ(number_text(0.1 + 0.2), "0.30000000000000004");
    EXPECT_EQ(number_text(0.1 + 0.2, {.decimals = 3}), "0.3");
    EXPECT_EQ(number_text(-0.0004, {.decimals = 3}), "0");
    EXPECT_EQ(number_text(1.99951, {.decimals = 3}), "2");
    EXPECT_EQ(numbers_text(std::vector<double>{1, -0.5, 2e-3}), "[1, -0.5, 0.002]");
}

TEST(NumberText, ReadsBackAsTheSameNumber) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> exponent(-300, 300), mantissa(-10, 10);
    for (int i = 0; i < 100000; ++i) {
        const double value = mantissa(random) * std::pow(10, exponent(random));
        EXPECT_EQ(std::strtod(number_text(value).c_str(), nullptr), value);
    }
    for (const double value :
         {std::numeric_limits<double>::min(), std::numeric_limits<double>::max(),
          std::numeric_limits<double>::denorm_min(), 1e15, 1e-6, 123456789012345.0})
        EXPECT_EQ(std::strtod(number_text(value).c_str(), nullptr), value);
}

}  // namespace
}  // namespace uw
