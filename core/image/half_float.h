#pragma once

#include <bit>
#include <cstdint>

namespace uw {

/// What is rounded to an infinite half float (IEEE 754 binary16): this and more. The largest finite
/// one is 65504.
inline constexpr float k_infinite_half = 65520.0F;

/// `value` rounded to the nearest half float, to even if two are equally near: its bits. NaN stays
/// NaN.
constexpr std::uint16_t half_bits(float value) {
    constexpr std::uint32_t k_infinity = 0x7f800000, k_overflow = 0x47800000;  // 2^16
    constexpr std::uint32_t k_normal = 0x38800000;                             // 2^-14
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16 & 0x8000, magnitude = bits & 0x7fffffff;
    std::uint32_t half = 0;
    if (magnitude >= k_overflow) {
        half = magnitude > k_infinity ? 0x7e00 : 0x7c00;
    } else if (magnitude < k_normal) {
        // Floats from 0.5 to 1 are multiples of 2^-24: the sum is rounded as the half should be.
        half = std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude) + 0.5F) -
               std::bit_cast<std::uint32_t>(0.5F);
    } else {
        constexpr std::uint32_t k_bias = 0x38000000;  // the difference of the exponents' biases
        half = (magnitude - k_bias + 0xfff + (magnitude >> 13 & 1)) >> 13;
    }
    return static_cast<std::uint16_t>(sign | half);
}

}  // namespace uw
