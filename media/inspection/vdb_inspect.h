#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ray.h"
#include "media/volumes/loaded_grid.h"
#include "media/volumes/vdb_header.h"

namespace uw {

/// The values in a grid's active voxels, as stored in the file; for vectors, their lengths. Tiles
/// count with all their voxels.
struct ValueSummary {
    std::int64_t active = 0;
    std::int64_t finite = 0, nan = 0, infinite = 0, negative = 0, zero = 0;
    double min = 0, mean = 0, max = 0;    // of the finite ones; 0 without any
    std::vector<std::int64_t> histogram;  // finite ones in equal bins from min to max
    std::string background;               // as text: a number, or three
    double background_value = 0;          // for vectors, its length
};

inline constexpr int k_histogram_bins = 20;

/// One grid of a file, as far as it can be interpreted.
struct GridInspection {
    GridSummary summary;
    /// Why it cannot be mapped to concentrations ("is a level set ..."); "" if it can.
    std::string unusable;
    /// Why its values were not read; "" if they were.
    std::string unread;
    /// "uniform scale", "scale", "rotated, uniform scale", "sheared", "frustum" and so on, with ",
    /// mirrored" appended if it mirrors; "" if the transform cannot be read.
    std::string transform;
    Vector3 voxel_size{0};        // edges along i, j, k [m]; for a frustum, those at its centre
    std::optional<IndexBox> box;  // of the active voxels; empty if there are none or it is unknown
    /// World bounding box of the active voxels, each a cell around its value's position [m]; empty
    /// if there are none.
    Bounds world_bounds;
    std::optional<ValueSummary> values;  // if they were read
    /// Active voxels: counted, or else as stated by the file.
    std::optional<std::int64_t> active_voxels;
};

struct VdbInspection {
    VdbHeader header;
    Placement placement;  // the default for a scene that does not specify it
    std::vector<GridInspection> grids;
};

/// Inspects every grid of a file, one at a time, and keeps no voxels. `up`: of the file, automatic
/// as in a scene that does not specify it. For a grid that cannot be read, or whose values are not
/// numbers, `unread` states why. Throws as read_vdb_header, and InputError if voxels are damaged
/// and no grid at all can be read.
VdbInspection inspect_vdb(const std::filesystem::path& file, const SourceLocation& where,
                          UpAxis up = UpAxis::automatic);

}  // namespace uw
