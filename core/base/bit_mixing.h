#pragma once

#include <cstdint>

namespace uw {

/// By which the state of splitmix64 grows from number to number.
inline constexpr std::uint64_t k_bit_mixing_step = 0x9e3779b97f4a7c15U;

/// splitmix64 (Steele, Lea and Flood 2014): the number that follows the state `x`. Every bit of the
/// result depends on all of `x`, and no two states have the same.
constexpr std::uint64_t mixed_bits(std::uint64_t x) {
    x += k_bit_mixing_step;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
}

}  // namespace uw
