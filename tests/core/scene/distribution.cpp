// ctest labels: unit statistical
#include "core/scene/variations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/base/random.h"

namespace uw {
namespace {

constexpr int k_draws = 100'000;

std::vector<double> draws_of(const NumberDistribution& distribution, const char* key) {
    std::vector<double> values;
    for (int i = 0; i < k_draws; ++i)
        values.push_back(quantile(distribution, draw_random(1, key, 0, i)));
    return values;
}

/// The largest difference between the fraction of draws up to a value and its probability
/// (Kolmogorov and Smirnov), times the square root of their number.
double kolmogorov_smirnov(std::vector<double> values,
                          const std::function<double(double)>& probability_up_to) {
    std::ranges::sort(values);
    const auto n = static_cast<double>(values.size());
    double largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double p = probability_up_to(values[i]);
        const auto rank = static_cast<double>(i);
        largest = std::max({largest, p - rank / n, (rank + 1) / n - p});
    }
    return largest * std::sqrt(n);
}

// 2 exp(-2 x^2) = 1e-5: of right code one in 1e5 seeds exceeds it, and the seed is fixed.
constexpr double k_max_distance = 2.47;

double normal_up_to(double x) {
    return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

TEST(Distribution, UniformDrawsFollowTheirClosedForm) {
    EXPECT_LT(kolmogorov_smirnov(draws_of(UniformDistribution{-3, 5}, "a"),
                                 [](double x) { return (x + 3) / 8; }),
              k_max_distance);
}

TEST(Distribution, LogarithmsOfLogUniformDrawsAreUniform) {
    EXPECT_LT(kolmogorov_smirnov(draws_of(LogUniformDistribution{0.01, 100}, "a"),
                                 [](double x) { return std::log(x / 0.01) / std::log(1e4); }),
              k_max_distance);
}

TEST(Distribution, NormalDrawsFollowTheirClosedForm) {
    EXPECT_LT(kolmogorov_smirnov(draws_of(NormalDistribution{20, 3}, "a"),
                                 [](double x) { return normal_up_to((x - 20) / 3); }),
              k_max_distance);
}

TEST(Distribution, TruncatedNormalDrawsAreThoseWithinAlone) {
    const double below = normal_up_to(-0.5), above = normal_up_to(2);
    const std::vector<double> values = draws_of(NormalDistribution{20, 2, 19, 24}, "a");
    EXPECT_GE(std::ranges::min(values), 19);
    EXPECT_LE(std::ranges::max(values), 24);
    EXPECT_LT(kolmogorov_smirnov(
                  values,
                  [&](double x) { return (normal_up_to((x - 20) / 2) - below) / (above - below); }),
              k_max_distance);
}

TEST(Distribution, ATailIsAsPreciseOnEitherSide) {
    const NormalDistribution upper{0, 1, 4, 12};
    const NormalDistribution lower{0, 1, -12, -4};
    for (const double u : {0.001, 0.3, 0.9}) {
        const double x = quantile(upper, u);
        EXPECT_DOUBLE_EQ(x, -quantile(lower, 1 - u));
        // The part u of the tail lies below x: its rest above. erfc has 1e-15 of relative
        // precision, and x 1e-12 standard deviations, of which the tail changes by 1e-11.
        EXPECT_NEAR(std::erfc(x / std::numbers::sqrt2) / std::erfc(4 / std::numbers::sqrt2), 1 - u,
                    1e-10);
    }
}

TEST(Distribution, QuantilesOfTheNormalDistributionAreThoseOfTables) {
    EXPECT_NEAR(quantile(NormalDistribution{}, 0.5), 0, 1e-12);
    EXPECT_NEAR(quantile(NormalDistribution{}, 0.975), 1.959963984540054, 1e-12);
    EXPECT_NEAR(quantile(NormalDistribution{}, 0.001), -3.090232306167813, 1e-12);
}

TEST(Distribution, WholeNumbersAreAllAsLikelyAndNoOtherIsDrawn) {
    std::vector<int> counts(7);
    for (const double value : draws_of(IntegerDistribution{-2, 4}, "a")) {
        ASSERT_EQ(value, std::floor(value));
        ASSERT_GE(value, -2);
        ASSERT_LE(value, 4);
        ++counts[static_cast<std::size_t>(value + 2)];
    }
    double chi_square = 0;
    constexpr double k_expected = k_draws / 7.0;
    for (const int count : counts)
        chi_square += (count - k_expected) * (count - k_expected) / k_expected;
    EXPECT_LT(chi_square, 33.1);  // of 6 degrees of freedom: exceeded once in 1e5
}

TEST(Distribution, TheLargestWholeNumbersAreReached) {
    const IntegerDistribution all{-2147483647, 2147483647};
    EXPECT_EQ(quantile(all, 0x1p-53), -2147483647);
    EXPECT_EQ(quantile(all, 1 - 0x1p-53), 2147483647);
}

TEST(DrawRandom, NeitherKeysNorVariationsNorSeedsAreCorrelated) {
    const auto correlation = [](const auto& a, const auto& b) {
        double sum = 0;
        for (int i = 0; i < k_draws; ++i) sum += (a(i) - 0.5) * (b(i) - 0.5);
        return 12 * sum / k_draws;
    };
    const auto number = [](std::uint64_t seed, const char* key, std::size_t component, int shift) {
        return [=](int i) { return draw_random(seed, key, component, i + shift); };
    };
    const auto one = number(1, "lamps.left.power", 0, 0);
    // Standard deviation 1 / sqrt(n) = 0.0032; 4.5 of them.
    constexpr double k_most = 0.0142;
    EXPECT_NEAR(correlation(one, one), 1, k_most);
    EXPECT_NEAR(correlation(one, number(1, "lamps.left.power", 0, 1)), 0, k_most);
    EXPECT_NEAR(correlation(one, number(1, "lamps.left.power", 1, 0)), 0, k_most);
    EXPECT_NEAR(correlation(one, number(2, "lamps.left.power", 0, 0)), 0, k_most);
    EXPECT_NEAR(correlation(one, number(1, "lamps.right.power", 0, 0)), 0, k_most);
}

}  // namespace
}  // namespace uw
