#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace uw {

/// Statistics of a grid's active voxels (tiles count with all their voxels). By OpenVDB's
/// convention inactive voxels are not data, whatever value a writer left in them.
struct GridStatistics {
    std::int64_t active_voxels = 0;
    std::int64_t nan_voxels = 0, infinite_voxels = 0, negative_voxels = 0;  // treated as 0
    double background = 0;                                                  // treated as 0
    double min = 0, mean = 0, max = 0;  // over active voxels, with invalid values set to 0
};

/// Takes voxel values one by one, sanitises each and updates the counts.
struct GridIntake {
    std::int64_t active = 0, nan = 0, infinite = 0, negative = 0;
    double sum = 0;
    float min = std::numeric_limits<float>::infinity(), max = -min;

    /// The sanitised `value`, counted for `voxels` voxels.
    float take(float value, std::int64_t voxels) {
        active += voxels;
        if (!std::isfinite(value)) {
            (std::isnan(value) ? nan : infinite) += voxels;
            value = 0;
        } else if (value < 0) {
            negative += voxels;
            value = 0;
        }
        sum += static_cast<double>(value) * static_cast<double>(voxels);
        min = std::min(min, value);
        max = std::max(max, value);
        return value;
    }
    /// Adds the counts of another part of the grid.
    void add(const GridIntake& other) {
        active += other.active;
        nan += other.nan;
        infinite += other.infinite;
        negative += other.negative;
        sum += other.sum;
        min = std::min(min, other.min);
        max = std::max(max, other.max);
    }
    GridStatistics statistics(double background) const;
};

/// Warnings about a grid's values, one line each, all beginning with `prefix`.
std::vector<std::string> intake_warnings(const GridStatistics& statistics,
                                         const std::string& prefix);

}  // namespace uw
