#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ray.h"
#include "media/vdb/placement.h"
#include "media/vdb/vdb_header.h"

namespace uw {

/// The values in a grid's active voxels, as they are in the file; of vectors, their lengths. Tiles
/// count with all their voxels.
struct ValueSummary {
    std::int64_t active = 0;
    std::int64_t finite = 0, nan = 0, infinite = 0, negative = 0, zero = 0;
    double min = 0, mean = 0, max = 0;    // of the finite ones; 0 without any
    std::vector<std::int64_t> histogram;  // finite ones in bins of one width from min to max
    std::string background;               // as text: a number, or three
    double background_value = 0;          // of vectors, its length
};

inline constexpr int k_histogram_bins = 20;

/// One grid of a file as far as it can be understood.
struct GridInspection {
    GridSummary summary;
    /// Why it cannot be mapped to concentrations ("is a level set ..."); "" if it can.
    std::string unusable;
    /// Why its values were not read; "" if they were.
    std::string unread;
    /// "uniform scale", "scale", "rotated, uniform scale", "sheared", "frustum" and so on, with
    /// ", mirrored" behind it where it mirrors; "" if the transform cannot be read.
    std::string transform;
    Vector3 voxel_size{0};        // edges along i, j, k [m]; of a frustum, those in its middle
    std::optional<IndexBox> box;  // of the active voxels; none if there are none, or nobody says
    /// World box of the active voxels, each a cell around its value's place [m]; empty without.
    Bounds world_bounds;
    std::optional<ValueSummary> values;  // where they were read
    /// Active voxels: counted, or else what the file says.
    std::optional<std::int64_t> active_voxels;
};

struct VdbInspection {
    VdbHeader header;
    Placement placement;  // what a scene that does not say gets
    std::vector<GridInspection> grids;
};

/// Looks at every grid of a file, one after the other, and keeps no voxels. A grid that cannot be
/// read, or whose values are no numbers, says so in `unread`. Throws as read_vdb_header, and
/// InputError if voxels are damaged and no grid at all can be read.
VdbInspection inspect_vdb(const std::filesystem::path& file, const SourceLocation& where);

}  // namespace uw
