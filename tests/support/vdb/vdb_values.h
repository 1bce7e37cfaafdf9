#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/vector_math.h"

namespace uw::test {

struct VdbValues {
    struct Voxel {
        Point3 position;  // world space of the file
        double value = 0;
        bool active = false;
    };
    std::vector<Voxel> voxels;  // of the box around all active ones
    std::map<std::string, std::string> metadata;
};

/// All float grids of a file by name, as OpenVDB itself reads them.
std::map<std::string, VdbValues> read_vdb_values(const std::filesystem::path& file);

}  // namespace uw::test
