#include "core/colour/band_intervals.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace uw {

std::vector<BandInterval> band_intervals(std::span<const double> bands_nm) {
    const std::size_t count = bands_nm.size();
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return bands_nm[i]; });
    std::vector<BandInterval> intervals(count);
    for (std::size_t k = 0; k < count; ++k) {
        const double at = bands_nm[order[k]];
        const double below = k > 0 ? 0.5 * (at - bands_nm[order[k - 1]]) : 0;
        const double above = k + 1 < count ? 0.5 * (bands_nm[order[k + 1]] - at) : 0;
        intervals[order[k]] = {at - (k > 0 ? below : above), at + (k + 1 < count ? above : below)};
    }
    return intervals;
}

double mean_band_width(std::span<const BandInterval> intervals) {
    double sum = 0;
    for (const BandInterval& interval : intervals) sum += interval.width();
    return sum / static_cast<double>(intervals.size());
}

}  // namespace uw
