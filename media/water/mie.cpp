#include "media/water/mie.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/numerics.h"

namespace uw {

namespace {

using Complex = std::complex<double>;

/// How many orders of the series matter (Wiscombe 1980).
std::size_t order_count(double x) {
    return static_cast<std::size_t>(x + 4.05 * std::cbrt(x) + 2);
}

/// Logarithmic derivatives psi_n'(z) / psi_n(z) of the Riccati-Bessel functions, n = 0 .. orders,
/// by downward recurrence from an order where the starting value no longer matters.
std::vector<Complex> first_kind(Complex z, std::size_t orders) {
    constexpr std::size_t k_forgotten = 16;
    const std::size_t begin =
        std::max(orders, static_cast<std::size_t>(std::abs(z) + 4.05 * std::cbrt(std::abs(z)))) +
        k_forgotten;
    std::vector<Complex> d(orders + 1);
    Complex next = 0;
    for (std::size_t n = begin; n > 0; --n) {
        const Complex ratio = static_cast<double>(n) / z;
        next = ratio - 1.0 / (next + ratio);
        if (n - 1 <= orders) d[n - 1] = next;
    }
    return d;
}

/// The logarithmic derivatives of the functions of the third kind, by upward recurrence (Yang 2003,
/// eqs. 23 and 24).
std::vector<Complex> third_kind(Complex z, const std::vector<Complex>& first) {
    constexpr Complex k_i{0, 1};
    std::vector<Complex> d(first.size());
    d[0] = k_i;
    Complex product = 0.5 * (1.0 - std::exp(2.0 * k_i * z));  // psi_n zeta_n
    for (std::size_t n = 1; n < d.size(); ++n) {
        const Complex ratio = static_cast<double>(n) / z;
        product *= (ratio - first[n - 1]) * (ratio - d[n - 1]);
        d[n] = first[n] + k_i / product;
    }
    return d;
}

/// Logarithmic derivatives on the inner side of the surface, for a_n and for b_n (H^a, H^b).
struct InnerDerivatives {
    std::vector<Complex> a, b;
};

InnerDerivatives coated(const MieSphere& sphere, std::size_t orders) {
    const Complex m1 = sphere.core->index, m2 = sphere.index;
    const double x1 = sphere.core->size_parameter, x2 = sphere.size_parameter;
    const Complex inner = m2 * x1, outer = m2 * x2;
    const std::vector<Complex> core = first_kind(m1 * x1, orders);
    const std::vector<Complex> d1_inner = first_kind(inner, orders);
    const std::vector<Complex> d1_outer = first_kind(outer, orders);
    const std::vector<Complex> d3_inner = third_kind(inner, d1_inner);
    const std::vector<Complex> d3_outer = third_kind(outer, d1_outer);
    // psi_n(inner) zeta_n(outer) / (zeta_n(inner) psi_n(outer)) (Yang 2003, eqs. 19 and 20)
    constexpr Complex k_i{0, 1};
    Complex ratio = std::exp(2.0 * k_i * (outer - inner)) * (std::exp(2.0 * k_i * inner) - 1.0) /
                    (std::exp(2.0 * k_i * outer) - 1.0);
    InnerDerivatives h{std::vector<Complex>(orders + 1), std::vector<Complex>(orders + 1)};
    for (std::size_t n = 1; n <= orders; ++n) {
        const auto order = static_cast<double>(n);
        ratio *= (x1 / x2) * (x1 / x2) * (outer * d1_outer[n] + order) /
                 (inner * d1_inner[n] + order) * (order - outer * d3_outer[n - 1]) /
                 (order - inner * d3_inner[n - 1]);
        const auto through = [&](Complex first, Complex third) {
            return (third * d1_outer[n] - ratio * first * d3_outer[n]) / (third - ratio * first);
        };
        h.a[n] = through(m2 * core[n] - m1 * d1_inner[n], m2 * core[n] - m1 * d3_inner[n]);
        h.b[n] = through(m1 * core[n] - m2 * d1_inner[n], m1 * core[n] - m2 * d3_inner[n]);
    }
    return h;
}

InnerDerivatives inner_derivatives(const MieSphere& sphere, std::size_t orders) {
    if (sphere.core) return coated(sphere, orders);
    std::vector<Complex> d = first_kind(sphere.index * sphere.size_parameter, orders);
    return {d, d};
}

}  // namespace

MieScattering::MieScattering(const MieSphere& sphere) {
    const double x = sphere.size_parameter;
    const std::size_t orders = order_count(x);
    const InnerDerivatives inner = inner_derivatives(sphere, orders);
    // psi_n and chi_n upwards (Bohren and Huffman 1983, app. A)
    double psi_before = std::cos(x), psi = std::sin(x);
    double chi_before = -std::sin(x), chi = std::cos(x);
    Complex a_before = 0, b_before = 0;
    double asymmetry = 0;
    for (std::size_t at = 1; at <= orders; ++at) {
        const auto n = static_cast<double>(at);
        const double next_psi = (2 * n - 1) / x * psi - psi_before;
        const double next_chi = (2 * n - 1) / x * chi - chi_before;
        const Complex xi{next_psi, -next_chi}, xi_before{psi, -chi};
        const Complex for_a = inner.a[at] / sphere.index + n / x;
        const Complex for_b = inner.b[at] * sphere.index + n / x;
        const Complex a = (for_a * next_psi - psi) / (for_a * xi - xi_before);
        const Complex b = (for_b * next_psi - psi) / (for_b * xi - xi_before);
        psi_before = psi, psi = next_psi;
        chi_before = chi, chi = next_chi;

        const double c = (2 * n + 1) / (n * (n + 1));
        sums_.push_back(c * (a + b));
        differences_.push_back(c * (a - b));
        extinction_ += (2 * n + 1) * (a + b).real();
        scattering_ += (2 * n + 1) * (std::norm(a) + std::norm(b));
        asymmetry += c * (a * std::conj(b)).real();
        if (at > 1)
            asymmetry +=
                (n * n - 1) / n * (a_before * std::conj(a) + b_before * std::conj(b)).real();
        a_before = a, b_before = b;
    }
    const double area = x * x / 2;
    mean_cosine_ = scattering_ > 0 ? 2 * asymmetry / scattering_ : 0;
    extinction_ /= area;
    scattering_ /= area;
}

namespace {

constexpr std::size_t k_block = 8;  // cosines at once, so that the compiler uses vectors

/// sum of sums_n (pi_n + tau_n) and of differences_n (pi_n - tau_n): S1 + S2 and S1 - S2.
struct Block {
    std::array<double, k_block> cosine{}, plus_re{}, plus_im{}, minus_re{}, minus_im{};
};

/// (2n + 1) / n and (n + 1) / n from n = 1 on: divisions would take a quarter of the time.
struct Ratios {
    double of_pi, of_before;
};

std::vector<Ratios> ratios(std::size_t orders) {
    std::vector<Ratios> all;
    for (std::size_t at = 0; at < orders; ++at) {
        const auto n = static_cast<double>(at + 1);
        all.push_back({(2 * n + 1) / n, (n + 1) / n});
    }
    return all;
}

UWVDB_VECTOR_CLONES void add_orders(Block& block, const Complex* sums, const Complex* differences,
                                    const std::vector<Ratios>& ratios) {
    std::array<double, k_block> pi_before{}, pi{};
    pi.fill(1);
    for (std::size_t at = 0; at < ratios.size(); ++at) {
        const auto n = static_cast<double>(at + 1);
        const double s_re = sums[at].real(), s_im = sums[at].imag();
        const double d_re = differences[at].real(), d_im = differences[at].imag();
        const auto [of_pi, of_before] = ratios[at];
        for (std::size_t i = 0; i < k_block; ++i) {
            const double scaled = block.cosine[i] * pi[i];
            const double tau = n * scaled - (n + 1) * pi_before[i];
            const double plus = pi[i] + tau, minus = pi[i] - tau;
            block.plus_re[i] += s_re * plus;
            block.plus_im[i] += s_im * plus;
            block.minus_re[i] += d_re * minus;
            block.minus_im[i] += d_im * minus;
            const double next = of_pi * scaled - of_before * pi_before[i];
            pi_before[i] = pi[i];
            pi[i] = next;
        }
    }
}

}  // namespace

void MieScattering::add_intensity(double weight, std::span<const double> cosines,
                                  std::span<double> sum) const {
    const std::vector<Ratios> of_orders = ratios(sums_.size());
    for (std::size_t first = 0; first < cosines.size(); first += k_block) {
        const std::size_t count = std::min(k_block, cosines.size() - first);
        Block block;
        std::copy_n(cosines.begin() + static_cast<std::ptrdiff_t>(first), count,
                    block.cosine.begin());
        add_orders(block, sums_.data(), differences_.data(), of_orders);
        for (std::size_t i = 0; i < count; ++i)
            sum[first + i] +=
                weight / 4 *
                (block.plus_re[i] * block.plus_re[i] + block.plus_im[i] * block.plus_im[i] +
                 block.minus_re[i] * block.minus_re[i] + block.minus_im[i] * block.minus_im[i]);
    }
}

std::pair<Complex, Complex> MieScattering::amplitudes(double cosine) const {
    Block block;
    block.cosine.fill(cosine);
    add_orders(block, sums_.data(), differences_.data(), ratios(sums_.size()));
    const Complex plus{block.plus_re[0], block.plus_im[0]};
    const Complex minus{block.minus_re[0], block.minus_im[0]};
    return {(plus + minus) / 2.0, (plus - minus) / 2.0};
}

}  // namespace uw
