// ctest labels: statistical
#include "core/base/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace uw {
namespace {

/// Deviations beyond this many standard errors have a probability below 1e-6; seeds are fixed, so
/// that a test that passes once always does.
constexpr double k_sigmas = 5;

/// Chi-square of counts against probabilities, in standard deviations from its mean; classes with
/// fewer than ten expected are merged with their neighbours.
double chi_square_excess(const std::vector<double>& counts, const std::vector<double>& probability,
                         double total) {
    double sum = 0, merged_count = 0, merged_expected = 0;
    int classes = 0;
    const auto close = [&] {
        sum += std::pow(merged_count - merged_expected, 2) / merged_expected;
        merged_count = merged_expected = 0;
        ++classes;
    };
    double left = total;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        merged_count += counts[i];
        merged_expected += total * probability[i];
        left -= total * probability[i];
        if (merged_expected >= 10 && left >= 10) close();
    }
    merged_expected += std::max(0.0, left);  // beyond the last class
    close();
    const double degrees = classes - 1;
    return (sum - degrees) / std::sqrt(2 * degrees);
}

std::vector<double> poisson_probabilities(double mean, std::size_t size) {
    std::vector<double> result;
    for (std::size_t k = 0; k < size; ++k) {
        const auto count = static_cast<long double>(k);
        const auto m = static_cast<long double>(mean);
        result.push_back(
            static_cast<double>(std::exp(count * std::log(m) - m - std::lgamma(count + 1))));
    }
    return result;
}

TEST(RandomCounts, FollowPoissonsDistribution) {
    constexpr int k_draws = 200'000;
    // On both sides of 30, where the method changes.
    for (const double mean : {0.02, 0.3, 1.0, 4.5, 12.0, 29.9, 30.0, 31.0, 55.5, 140.0, 1000.0}) {
        const auto size = static_cast<std::size_t>(mean + 12 * std::sqrt(mean) + 20);
        std::vector<double> counts(size);
        for (int i = 0; i < k_draws; ++i) {
            PathRandom random(PathRandom::seed_of(7, static_cast<std::uint64_t>(i)), 0);
            const double count = poisson(mean, random);
            ASSERT_EQ(count, std::floor(count));
            ASSERT_GE(count, 0);
            ASSERT_LT(count, static_cast<double>(size));
            counts[static_cast<std::size_t>(count)] += 1;
        }
        EXPECT_LT(chi_square_excess(counts, poisson_probabilities(mean, size), k_draws), k_sigmas)
            << mean;
    }
}

TEST(RandomCounts, HaveMeanAndVarianceOfPoissonUpToTheBrightestLight) {
    constexpr int k_draws = 100'000;
    for (const double mean : {1e4, 1e6, 1e9, 1e12}) {
        double sum = 0, squares = 0;
        for (int i = 0; i < k_draws; ++i) {
            PathRandom random(PathRandom::seed_of(11, static_cast<std::uint64_t>(i)), 0);
            const double deviation = (poisson(mean, random) - mean) / std::sqrt(mean);
            sum += deviation;
            squares += deviation * deviation;
        }
        EXPECT_LT(std::abs(sum) / std::sqrt(k_draws), k_sigmas) << mean;
        // The variance of z^2 is 2.
        EXPECT_LT(std::abs(squares / k_draws - 1) / std::sqrt(2.0 / k_draws), k_sigmas) << mean;
    }
}

TEST(RandomCounts, AreZeroWithoutLight) {
    PathRandom random(1, 0);
    EXPECT_EQ(poisson(0, random), 0);
    EXPECT_EQ(poisson(-1, random), 0);
    EXPECT_EQ(poisson(std::nan(""), random), 0);
}

TEST(RandomCounts, NormalPairsFillEqualClassesEqually) {
    constexpr int k_draws = 200'000;
    constexpr std::size_t k_classes = 20;
    std::vector<double> counts(k_classes * k_classes);
    const auto class_of = [](double z) {
        const double probability = 0.5 * std::erfc(-z / std::numbers::sqrt2);
        return std::min(static_cast<std::size_t>(probability * k_classes), k_classes - 1);
    };
    for (int i = 0; i < k_draws; ++i) {
        PathRandom random(PathRandom::seed_of(3, static_cast<std::uint64_t>(i)), 0);
        const NormalPair pair = standard_normals(random);
        counts[class_of(pair.first) * k_classes + class_of(pair.second)] += 1;
    }
    const std::vector<double> equal(counts.size(), 1.0 / static_cast<double>(counts.size()));
    EXPECT_LT(chi_square_excess(counts, equal, k_draws), k_sigmas);
}

}  // namespace
}  // namespace uw
