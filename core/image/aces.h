#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace uw {

/// ACES2065-1 from linear sRGB: its primaries are AP0 and its white is (.32168, .33767) (SMPTE ST
/// 2065-1), to which D65 is adapted by Bradford's matrix, as in the Academy's own transforms.
inline constexpr std::array<std::array<double, 3>, 3> k_aces_from_srgb{
    {{0.439632981919, 0.382988698152, 0.177378319929},
     {0.089776442959, 0.813439428749, 0.096784128292},
     {0.017541170383, 0.111546553302, 0.870912276314}}};

inline void srgb_to_aces(std::span<float, 3> rgb) {
    const std::array<double, 3> srgb{rgb[0], rgb[1], rgb[2]};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& row = k_aces_from_srgb[i];
        rgb[i] = static_cast<float>(row[0] * srgb[0] + row[1] * srgb[1] + row[2] * srgb[2]);
    }
}

}  // namespace uw
