#include "core/paths/path_random.h"

#include <array>

#include "core/base/bit_mixing.h"

namespace uw {

namespace {

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
    if (in_lattice) bits += std::uint64_t{point_ * k_generator[dimension]} << 32U;
    return static_cast<double>(bits >> 11U) * 0x1p-53;
}

std::uint64_t PathRandom::seed_of(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    return mixed_bits(mixed_bits(mixed_bits(a) ^ b) ^ c);
}

}  // namespace uw
