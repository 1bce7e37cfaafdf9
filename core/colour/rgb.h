#pragma once

#include <array>
#include <cmath>

namespace uw {

/// Linear red, green, blue of a diffuse reflectance, 0..1 (sRGB primaries, as in files).
using Rgb = std::array<double, 3>;

/// IEC 61966-2-1: the sRGB code value in 0..1 as linear light.
inline double linear_from_srgb(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace uw
