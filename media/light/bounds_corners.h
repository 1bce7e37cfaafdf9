#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "core/base/ray.h"

namespace uw {

inline constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// The corners of a box.
inline std::array<Point3, 8> corners(const Bounds& b) {
    std::array<Point3, 8> result;
    for (std::size_t i = 0; i < 8; ++i)
        result[i] = {(i & 1) != 0 ? b.max.x : b.min.x, (i & 2) != 0 ? b.max.y : b.min.y,
                     (i & 4) != 0 ? b.max.z : b.min.z};
    return result;
}

}  // namespace uw
