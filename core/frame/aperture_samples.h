#pragma once

#include <cmath>
#include <numbers>

#include "core/base/ray_source.h"

namespace uw {

/// The point of the aperture that belongs to a point of the unit square, evenly, by squares that
/// become rings (Shirley and Chiu 1997): neighbours stay neighbours.
inline AperturePoint aperture_point(double a, double b) {
    const double x = 2 * a - 1, y = 2 * b - 1;
    if (x == 0 && y == 0) return {};
    const bool is_wide = std::abs(x) > std::abs(y);
    const double radius = is_wide ? x : y;
    const double quarter = std::numbers::pi / 4;
    const double angle = is_wide ? quarter * (y / x) : 2 * quarter - quarter * (x / y);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace uw
