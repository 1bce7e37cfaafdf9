#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace uw {

/// One of several alternatives, drawn at random.
struct Choice {
    std::size_t index = 0;
    double probability = 1;
};

/// Chooses between alternatives with the weights whose running sums are `cumulative` (not empty,
/// the last > 0). `u` in [0, 1) is replaced by a number that is again uniform in [0, 1).
inline Choice choose(std::span<const double> cumulative, double& u) {
    const double target = u * cumulative.back();
    std::size_t index = 0;
    while (index + 1 < cumulative.size() && cumulative[index] <= target) ++index;
    const double before = index == 0 ? 0.0 : cumulative[index - 1];
    const double weight = cumulative[index] - before;
    u = weight > 0 ? std::clamp((target - before) / weight, 0.0, 1.0) : 0.0;
    return {index, weight / cumulative.back()};
}

}  // namespace uw
