#include "core/base/random.h"

#include <array>
#include <cmath>
#include <numbers>

namespace uw {

namespace {

/// The increment of splitmix64's state.
constexpr std::uint64_t k_bit_mixing_step = 0x9e3779b97f4a7c15U;

/// splitmix64 (Steele, Lea and Flood 2014): the number that follows the state `x`. Every bit of the
/// result depends on all of `x`, and no two states have the same.
constexpr std::uint64_t mixed_bits(std::uint64_t x) {
    x += k_bit_mixing_step;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
}

// Cools, Kuo and Nuyens: "lattice-32001-1024-1048576.3600", an extensible rank-1 lattice for up to
// 2^20 points; the rule's first components.
constexpr std::array<std::uint32_t, 24> k_generator{
    1,      182667, 469891, 498753, 110745, 446247, 250185, 118627, 245333, 283199, 408519, 391023,
    246327, 126539, 399185, 461527, 300343, 69681,  516695, 436179, 106383, 238523, 413283, 70841};

std::uint32_t reversed(std::uint32_t x) {
    x = (x << 16U) | (x >> 16U);
    x = ((x & 0x00ff00ffU) << 8U) | ((x & 0xff00ff00U) >> 8U);
    x = ((x & 0x0f0f0f0fU) << 4U) | ((x & 0xf0f0f0f0U) >> 4U);
    x = ((x & 0x33333333U) << 2U) | ((x & 0xccccccccU) >> 2U);
    return ((x & 0x55555555U) << 1U) | ((x & 0xaaaaaaaaU) >> 1U);
}

}  // namespace

PathRandom::PathRandom(std::uint64_t seed, std::uint32_t index)
    : seed_(seed), stream_(mixed_bits(seed ^ mixed_bits(index))), point_(reversed(index)) {}

double PathRandom::next() {
    const auto dimension = static_cast<std::uint64_t>(dimension_++);
    const bool in_lattice = dimension < k_generator.size();
    std::uint64_t bits = mixed_bits((in_lattice ? seed_ : stream_) + k_bit_mixing_step * dimension);
    if (in_lattice) {
        const std::uint32_t coordinate = point_ * k_generator[dimension];  // modulo 2^32
        bits += std::uint64_t{coordinate} << 32U;
    }
    return static_cast<double>(bits >> 11U) * 0x1p-53;
}

std::uint64_t PathRandom::seed_of(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    return mixed_bits(mixed_bits(mixed_bits(a) ^ b) ^ c);
}

double draw_random(std::uint64_t seed, std::string_view key, std::size_t component, int variation) {
    std::uint64_t state = mixed_bits(seed);
    for (const char c : key) state = mixed_bits(state ^ static_cast<unsigned char>(c));
    state = mixed_bits(mixed_bits(state ^ component) ^ static_cast<std::uint64_t>(variation));
    return (static_cast<double>(state >> 12U) + 0.5) * 0x1p-52;
}

namespace {

constexpr double k_min_mean_of_rejection = 30;  // the method needs 10

/// Inversion: adds up the probabilities of 0, 1, 2, ...
double by_inversion(double mean, double u) {
    double count = 0, probability = std::exp(-mean), sum = probability;
    // The sum stops short of 1 by its rounding.
    while (u >= sum && probability > 0) {
        count += 1;
        probability *= mean / count;
        sum += probability;
    }
    return count;
}

/// ln k! - (k ln k - k + ln(2 pi k) / 2), k >= 1.
double stirling_error(double k) {
    constexpr double k_min_of_series = 16;  // its next term is 1e-13
    if (k < k_min_of_series) {
        double factorial = 1;
        for (double i = 2; i <= k; ++i) factorial *= i;  // exact
        return std::log(factorial) -
               (k * std::log(k) - k + 0.5 * std::log(2 * std::numbers::pi * k));
    }
    const double square = k * k;
    return (1.0 / 12 - (1.0 / 360 - (1.0 / 1260 - 1.0 / 1680 / square) / square) / square) / k;
}

/// Logarithm of the probability of `count`, without the cancellation of k ln m - ln k! - m (Loader
/// 2000, "Fast and accurate computation of binomial probabilities").
double log_probability(double count, double mean) {
    if (count == 0) return -mean;
    const double x = (count - mean) / mean;
    const double deviance = mean * ((1 + x) * std::log1p(x) - x);
    return -deviance - 0.5 * std::log(2 * std::numbers::pi * count) - stirling_error(count);
}

double by_rejection(double mean, PathRandom& random) {
    const double b = 0.931 + 2.53 * std::sqrt(mean);
    const double a = -0.059 + 0.02483 * b;
    const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
    const double within = 0.9277 - 3.6224 / (b - 2);
    for (;;) {
        const double u = random.next() - 0.5, v = 1 - random.next();
        const double us = 0.5 - std::abs(u);
        if (!(us > 0)) continue;
        const double count = std::floor((2 * a / us + b) * u + mean + 0.43);
        if (us >= 0.07 && v <= within) return count;
        if (count < 0 || (us < 0.013 && v > us)) continue;
        if (std::log(v * inverse_alpha / (a / (us * us) + b)) <= log_probability(count, mean))
            return count;
    }
}

}  // namespace

double poisson(double mean, PathRandom& random) {
    if (!(mean > 0)) return 0;
    if (mean < k_min_mean_of_rejection) return by_inversion(mean, random.next());
    return by_rejection(mean, random);
}

NormalPair standard_normals(PathRandom& random) {
    const double radius = std::sqrt(-2 * std::log(1 - random.next()));
    const double angle = 2 * std::numbers::pi * random.next();
    return {radius * std::cos(angle), radius * std::sin(angle)};
}
}  // namespace uw
