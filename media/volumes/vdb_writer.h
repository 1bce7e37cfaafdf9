#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/output_files.h"
#include "core/base/vector_math.h"

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

/// Writes all of a file with the grids, compressed, and `metadata` for the whole of it (other
/// programs display its "creator"). Throws IoError if OpenVDB refuses, and Interrupted; what cannot
/// be written is for out.commit() to report.
void write_vdb(OutputFile& out, const std::vector<VdbOutputGrid>& grids,
               const std::vector<std::pair<std::string, std::string>>& metadata);
/// Writes them to a file, which appears under its name only once it is complete.
void write_vdb(const std::filesystem::path& file, const std::vector<VdbOutputGrid>& grids,
               const std::vector<std::pair<std::string, std::string>>& metadata);

}  // namespace uw
