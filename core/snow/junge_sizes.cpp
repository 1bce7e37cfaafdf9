#include "core/snow/junge_sizes.h"

#include <cmath>
#include <numbers>

namespace uw {
namespace {

// Below this relative difference expm1(x)/x is 1.
constexpr double k_negligible = 1e-12;

/// int_a^b D^power dD, without cancellation where the power is nearly -1.
double integral_of_power(double power, double a, double b) {
    const double x = (power + 1) * std::log(b / a);
    const double ratio = std::abs(x) < k_negligible ? 1 : std::expm1(x) / x;
    return std::pow(a, power + 1) * std::log(b / a) * ratio;
}

}  // namespace

JungeSizes::JungeSizes(double exponent, double least, double greatest)
    : exponent_(exponent), least_(least), greatest_(greatest) {}

double JungeSizes::share(double a, double b) const {
    return integral_of_power(-exponent_, a, b) / integral_of_power(-exponent_, least_, greatest_);
}

double JungeSizes::quantile(double u, double a, double b) const {
    const double power = 1 - exponent_, x = power * std::log(b / a);
    if (std::abs(x) < k_negligible) return a * std::pow(b / a, u);
    return a * std::exp(std::log1p(u * std::expm1(x)) / power);
}

double JungeSizes::mean_area(double a, double b) const {
    return std::numbers::pi / 4 * integral_of_power(2 - exponent_, a, b) /
           integral_of_power(-exponent_, a, b);
}

}  // namespace uw
