#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/vec.h"

namespace uw {

/// A grid to be written as a 32-bit float fog volume. Value (i, j, k), 0 <= i < size[0] and so on,
/// sits at origin + voxel_size * (i, j, k) in metres; values equal to 0 become inactive.
struct VdbOutputGrid {
    std::string name;
    std::array<int, 3> size{};
    double voxel_size = 1;
    Point3 origin;
    /// Called once per (i, j, k), from one thread, in blocks of 8^3.
    std::function<float(int i, int j, int k)> value;
    std::vector<std::pair<std::string, std::string>> metadata;
};

/// Writes the grids, compressed, with `metadata` for the whole file (other programs display its
/// "creator"). The file appears under its name only once it is complete. Throws IoError.
void write_vdb(const std::filesystem::path& file, const std::vector<VdbOutputGrid>& grids,
               const std::vector<std::pair<std::string, std::string>>& metadata);

}  // namespace uw
