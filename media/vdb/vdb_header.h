#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/source_location.h"

namespace uw {

/// Voxels min to max, both included.
struct IndexBox {
    std::array<std::int32_t, 3> min{}, max{};
};

/// A VDB file's metadata for one of its grids, read without its voxels. Names are made printable.
struct GridSummary {
    std::string name;        // as used in scenes: "density", or "density[1]" if several share it
    std::string base_name;   // "density" in both cases
    std::string value_type;  // "float", "double", "vec3s", "ptdataidx32", ...
    bool half = false;       // saved with 16 bits per number
    std::string quantised;   // NanoVDB: "fp4", "fp8", "fp16" or "fpN" if saved so, else ""
    std::string grid_class = "unknown";         // "fog volume", "level set", "staggered", "unknown"
    std::optional<std::int64_t> active_voxels;  // if the file states it
    std::string map_type;                       // e.g. "UniformScaleMap", "NonlinearFrustumMap"
    /// Voxels of the domain along each axis, as Blender's fluid solver stores with each grid.
    std::optional<std::array<std::int32_t, 3>> base_resolution;
    bool from_embergen = false;          // it has EmberGen's metadata
    std::optional<double> voxel_edge;    // of a UniformScaleMap, in the file's unit
    std::optional<IndexBox> active_box;  // of the active voxels, if the file states it

    // For the reader: positions in the file.
    std::string tree_type;    // "Tree_float_5_4_3"
    std::string unique_name;  // raw
    std::string instance_of;  // raw unique name of the grid whose voxels this one shares, or ""
    std::uint32_t compression = 0;
    std::int64_t transform_offset = 0;
    std::int64_t blocks_offset = 0;  // NanoVDB: start of the grid's bytes
    std::int64_t stored_bytes = 0;   // NanoVDB: their number in the file,
    std::int64_t grid_bytes = 0;     // and once decompressed
};

/// A VDB file's metadata.
struct VdbHeader {
    std::filesystem::path file;
    bool is_nano = false;       // NanoVDB's own format (.nvdb); it has no version of its own
    std::uint32_t version = 0;  // of the format: 224 for OpenVDB 4 to 12
    std::uint32_t library_major = 0, library_minor = 0;
    std::string creator;  // file metadata "creator"; "" if there is none
    std::vector<GridSummary> grids;

    /// True for a cache of Blender's fluid solver (Mantaflow): no creator, and either the solver's
    /// own metadata or nothing but the names it uses.
    bool from_blender_fluid() const;
    /// True for what EmberGen exports: by its metadata or, without a creator, by `flames`, a name
    /// that only it uses.
    bool from_embergen() const;
    /// True for files written by Houdini, which names itself as their creator.
    bool from_houdini() const;
    /// One line that lists the grids with type and class, for messages.
    std::string describe_grids() const;
};

/// Voxels along the edge of a leaf node, in both OpenVDB and NanoVDB trees.
inline constexpr int k_leaf_edge = 8;

}  // namespace uw
