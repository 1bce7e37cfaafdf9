#pragma once

#include <limits>
#include <variant>

namespace uw {

/// Every number from `low` to `high` is as likely.
struct UniformDistribution {
    double low = 0, high = 1;
};
/// The logarithm is uniform: every ratio between 0 < `low` and `high` is as likely.
struct LogUniformDistribution {
    double low = 1, high = 10;
};
/// Normal, of which only what lies within [low, high] is drawn.
struct NormalDistribution {
    double mean = 0, deviation = 1;
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};
/// Every whole number from `low` to `high`, both included, is as likely.
struct IntegerDistribution {
    int low = 0, high = 1;
};

/// How a number is distributed.
using NumberDistribution = std::variant<UniformDistribution, LogUniformDistribution,
                                        NormalDistribution, IntegerDistribution>;

/// The probability of a standard normal number within [low, high], to full relative precision
/// wherever the interval lies.
double normal_probability(double low, double high);

/// The number below which the part `u`, in (0, 1), of the distribution lies: of a `u` that is
/// uniform the result is distributed so. Normal numbers are exact to 1e-12 standard deviations.
double quantile(const NumberDistribution& distribution, double u);

}  // namespace uw
