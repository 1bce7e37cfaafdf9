#include "media/water/fournier_forand.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace uw {

namespace {

/// (x^q - 1) / (x - 1), q at x = 1, without cancellation.
double power_quotient(double x, double q) {
    const double e = x - 1;
    return e == 0 ? q : std::expm1(q * std::log1p(e)) / e;
}

/// Binomial coefficients C(q, 2), C(q, 3), ... into `c`.
void binomials_from_2(double q, std::span<double> c) {
    double binomial = q;
    for (std::size_t i = 0; i < c.size(); ++i) {
        const auto k = static_cast<double>(i + 2);
        binomial *= (q - k + 1) / k;
        c[i] = binomial;
    }
}

double horner(std::span<const double> c, double x) {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
    return sum;
}

}  // namespace

FournierForand::FournierForand(double n, double mu)
    : n_(n), mu_(mu), nu_(0.5 * (3 - mu)), delta_180_(4 / (3 * (n - 1) * (n - 1))) {
    if (!(n > 1 && n <= 10))
        throw InputError(
            fmt::format("Fournier-Forand n = {} is out of range; give the particles' refractive "
                        "index relative to water, 1 < n <= 10 (1.02 to 1.2 in nature)",
                        n));
    if (!(mu > 3 && mu < 5))
        throw InputError(
            fmt::format("Fournier-Forand mu = {} is out of range; give the slope of the size "
                        "distribution, 3 < mu < 5",
                        mu));
    binomials_from_2(nu_, series_a_);
    binomials_from_2(nu_ + 1, series_b_);
    back_ = -power_quotient(delta_180_, nu_) / (16 * std::numbers::pi * std::pow(delta_180_, nu_));

    // Fraction scattered below k_min_angle (Mobley, from Fournier and Jonasz 1999), over the
    // cone's solid angle 4 pi sin^2(psi/2): the mean of p there, halfway between both ends.
    const double s = std::sin(0.5 * k_min_angle);
    const double s2 = s * s;
    const double delta = delta_180_ * s2;
    const double fraction =
        (power_quotient(delta, nu_ + 1) - power_quotient(delta, nu_) * s2) / std::pow(delta, nu_) +
        2 * std::numbers::pi * back_ * (1 - 2 * s2) * 4 * s2 * (1 - s2);
    const double mean = fraction / (4 * std::numbers::pi * s2), edge = value(s2);
    core_ = 2 * mean - edge;
    core_slope_ = (core_ - edge) / s2;
}

double FournierForand::value(double sin2_half) const {
    const double delta = delta_180_ * sin2_half;
    const double e = delta - 1;
    const double power_less_1 = std::expm1(nu_ * std::log(delta));  // accurate for small nu too
    const double power = 1 + power_less_1;
    double a = 0;  // (nu(1-d) - (1-d^nu)) / (1-d)^2
    double b = 0;  // (d(1-d^nu) - nu(1-d)) / (1-d)^2
    if (std::abs(e) < 0.05) {
        a = horner(series_a_, e);
        b = -horner(series_b_, e);
    } else {
        a = (power_less_1 - nu_ * e) / (e * e);
        b = (nu_ * e - delta * power_less_1) / (e * e);
    }
    const double cosine = 1 - 2 * sin2_half;
    return (a + b / sin2_half) / (4 * std::numbers::pi * power) + back_ * (3 * cosine * cosine - 1);
}

void FournierForand::eval(std::span<const double> psi, std::span<double> p) const {
    for (std::size_t i = 0; i < psi.size(); ++i) {
        const double s = std::sin(0.5 * psi[i]);
        p[i] = psi[i] < k_min_angle ? core_ - core_slope_ * s * s : value(s * s);
    }
}

std::vector<double> FournierForand::breakpoints() const {
    std::vector<double> angles;
    for (double angle = k_min_angle; angle < 0.5 * std::numbers::pi; angle *= 4)
        angles.push_back(angle);
    return angles;
}

std::string FournierForand::description() const {
    return fmt::format("fournier-forand n={} mu={}", n_, mu_);
}

}  // namespace uw
