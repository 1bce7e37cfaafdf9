#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

/// Placed before the definition of a function whose loops benefit from wider vector registers than
/// all processors have: the compiler emits a version for each of these targets and the loader picks
/// the widest that the machine supports. Results are bit-identical: nothing is contracted or
/// reordered. Not under the thread sanitizer, whose code would run in the loader before it is
/// ready, nor where the compiler compares all definitions of one name, which takes the versions
/// for different ones (scripts/check-all definitions).
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(UWVDB_ONE_DEFINITION)
#define UWVDB_VECTOR_CLONES [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#else
#define UWVDB_VECTOR_CLONES
#endif

namespace uw {

/// e^-x for x >= 0 (an optical depth), with relative error 1e-11, and 0 beyond x = 700. Free of
/// branches and calls, so that loops over it are vectorised: a third of the time of std::exp in the
/// integrators.
inline double exp_of_minus(double x) {
    constexpr double k_log2_e = 1.4426950408889634074;
    // ln 2 in two parts: the product of the first with any exponent is exact (Cody and Waite 1980).
    constexpr double k_ln2_high = 0x1.62e42fefap-1, k_ln2_low = 0x1.cf79abc9e3b39p-40;
    constexpr double k_to_integer = 0x1.8p52;  // adding it leaves the integer in the low bits

    const double y = -x;
    const double shifted = y * k_log2_e + k_to_integer;
    const double n = shifted - k_to_integer;
    const double r = (y - n * k_ln2_high) - n * k_ln2_low;  // |r| <= ln 2 / 2
    // Taylor series up to r^9: the remainder is r^10 / 10! < 7e-12.
    double p = 1.0 / 362880;
    for (const double c :
         {1.0 / 40320, 1.0 / 5040, 1.0 / 720, 1.0 / 120, 1.0 / 24, 1.0 / 6, 0.5, 1.0, 1.0})
        p = p * r + c;
    const auto exponent = std::bit_cast<std::uint64_t>(shifted);
    const double scale = std::bit_cast<double>((exponent + 1023) << 52);
    // By a mask: a choice between products, or numbers that lead to them, might spare an exception
    // of the floating-point unit, and GCC would not vectorise it.
    const std::uint64_t mask = x > 700 ? 0 : ~std::uint64_t{0};
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(p * scale) & mask);
}

/// Replaces every x >= 0 by e^-x.
void exp_of_minus(std::span<double> x);

/// One node of a quadrature rule on [0, 1]; weights sum to 1.
struct QuadratureNode {
    double position;
    double weight;
};

/// Gauss-Legendre rules on [0, 1] with `count` = 2..4 nodes: exact for polynomials of degree
/// 2 count - 1 (Abramowitz & Stegun, table 25.4).
std::span<const QuadratureNode> gauss_legendre(int count);

}  // namespace uw
