#include "media/vdb/grid_statistics.h"

#include <fmt/format.h>

namespace uw {

GridStatistics GridIntake::statistics(double background) const {
    GridStatistics statistics{active, nan, infinite, negative, background, 0, 0, 0};
    if (active == 0) return statistics;
    statistics.min = static_cast<double>(min);
    statistics.max = static_cast<double>(max);
    statistics.mean = sum / static_cast<double>(active);
    return statistics;
}

std::vector<std::string> intake_warnings(const GridStatistics& statistics,
                                         const std::string& prefix) {
    std::vector<std::string> warnings;
    const auto warn = [&](const std::string& what) { warnings.push_back(prefix + what); };
    const auto count = [&](std::int64_t voxels, const char* what) {
        if (voxels > 0)
            warn(fmt::format("{} of {} active voxels are {}: treated as 0", voxels,
                             statistics.active_voxels, what));
    };
    count(statistics.nan_voxels, "NaN");
    count(statistics.infinite_voxels, "infinite");
    count(statistics.negative_voxels, "negative");
    if (statistics.background != 0)
        warn(fmt::format("its background is {:g}: treated as 0 outside the active voxels",
                         statistics.background));
    if (statistics.active_voxels == 0)
        warn("it has no active voxels and contributes nothing");
    else if (statistics.max == 0)
        warn("all its active voxels are 0 and it contributes nothing");
    return warnings;
}

}  // namespace uw
