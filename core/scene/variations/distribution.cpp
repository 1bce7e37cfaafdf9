#include "core/scene/variations/distribution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {
namespace {

// Less than 1e-33 of a normal distribution lies beyond.
constexpr double k_farthest = 12;

/// The probability of a standard normal number above x.
double above(double x) {
    return 0.5 * std::erfc(x / std::numbers::sqrt2);
}

/// Of the standard normal distribution within [low, high].
double normal_quantile(double low, double high, double u) {
    if (low + high > 0) return -normal_quantile(-high, -low, 1 - u);  // the left tail is precise
    low = std::clamp(low, -k_farthest, k_farthest);
    high = std::clamp(high, -k_farthest, k_farthest);
    const double below = above(-low) + u * normal_probability(low, high);
    // Halved this often, 24 become 1e-12. What is left undecided hides the last digits of erfc,
    // which differ between systems: the draws do not.
    constexpr int k_halvings = 44;
    for (int i = 0; i < k_halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (above(-middle) < below ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double quantile_of(const UniformDistribution& d, double u) {
    return std::clamp(d.low + u * (d.high - d.low), d.low, d.high);
}

double quantile_of(const LogUniformDistribution& d, double u) {
    return std::clamp(d.low * std::exp(u * std::log(d.high / d.low)), d.low, d.high);
}

double quantile_of(const NormalDistribution& d, double u) {
    const double x =
        normal_quantile((d.low - d.mean) / d.deviation, (d.high - d.mean) / d.deviation, u);
    return std::clamp(d.mean + d.deviation * x, d.low, d.high);
}

double quantile_of(const IntegerDistribution& d, double u) {
    const double count = static_cast<double>(d.high) - d.low + 1;
    return std::min(d.low + std::floor(u * count), static_cast<double>(d.high));
}

}  // namespace

double normal_probability(double low, double high) {
    if (low + high < 0) return normal_probability(-high, -low);
    return above(low) - above(high);
}

double quantile(const NumberDistribution& distribution, double u) {
    return std::visit([u](const auto& d) { return quantile_of(d, u); }, distribution);
}

}  // namespace uw
