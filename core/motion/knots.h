#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace uw {

/// A place between two of a spline's knots.
struct KnotSpan {
    std::size_t first = 0;  // the knot before; of the last place, that before the last knot
    double width = 0;       // between the knots
    double share = 0;       // of the way to the next knot, 0 to 1
};

/// The span of `knots` (strictly ascending, at least two) in which `at` lies; places outside are
/// taken to the nearest end.
inline KnotSpan span_of(const std::vector<double>& knots, double at) {
    const double inside = std::clamp(at, knots.front(), knots.back());
    const auto after = std::upper_bound(knots.begin() + 1, knots.end() - 1, inside);
    const auto first = static_cast<std::size_t>(after - knots.begin()) - 1;
    const double width = knots[first + 1] - knots[first];
    return {first, width, (inside - knots[first]) / width};
}

}  // namespace uw
