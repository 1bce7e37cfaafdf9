#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scene/volume_desc.h"

namespace uw {

/// Voxels min to max, both included.
struct IndexBox {
    std::array<std::int32_t, 3> min{}, max{};
};

/// A VDB file's metadata for one of its grids, read without its voxels. Names are made printable.
struct GridSummary {
    /// As used in scenes: "density", "density[1]" if several share it, or "[0]" without a name.
    std::string name;
    std::string base_name;   // "density" in the first two cases
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

static_assert(std::endian::native == std::endian::little, "files are read as they lie");

/// Reads a little-endian binary file sequentially and never trusts a size that the file cannot
/// contain. Errors in the file become a one-line InputError that starts with `where`.
class ByteReader {
  public:
    static constexpr std::size_t k_longest_text = 4096;

    /// Throws IoError if the file cannot be opened. `file` and `where` must outlive the reader.
    ByteReader(const std::filesystem::path& file, const SourceLocation& where);

    std::int64_t size() const { return size_; }
    std::int64_t position() const { return position_; }

    /// Throws InputError: "<where>: '<file>' <what>".
    [[noreturn]] void fail(const std::string& what) const;
    [[noreturn]] void fail_damaged() const;

    void seek(std::int64_t position);
    void skip(std::int64_t bytes);

    template <class T>
    T get() {
        T value{};
        read(reinterpret_cast<char*>(&value), sizeof value);
        return value;
    }
    void read(char* to, std::size_t bytes);
    std::string text(std::size_t size);
    std::string text() { return text(get<std::uint32_t>()); }  // prefixed by its length

  private:
    const std::filesystem::path& file_;
    const SourceLocation& where_;
    std::ifstream stream_;
    std::vector<char>
        window_;  // the file's bytes from window_begin_ on, so that short seeks are cheap
    std::int64_t window_begin_ = 0;
    std::int64_t size_ = 0, position_ = 0;
};

/// Reads the header and the metadata of all grids of a VDB or NanoVDB file, distinguished by their
/// magic numbers; sizes that the file claims are first checked against its length. Throws IoError
/// if the file cannot be opened; InputError, starting with `where`, if it is neither, is truncated,
/// or has a version other than 220 to 224 (NanoVDB: 32).
VdbHeader read_vdb_header(const std::filesystem::path& file, const SourceLocation& where);

/// The grid that a scene calls `name`, whatever it contains. Throws InputError, starting with
/// `where`, for a name that is missing or shared by several grids; the message lists the file's
/// grids.
const GridSummary& grid_called(const VdbHeader& header, const std::string& name,
                               const SourceLocation& where);

/// Why the grid's values cannot be concentrations, to follow "grid 'x' "; "" if its header gives no
/// such reason.
std::string unusable_because(const GridSummary& grid, LevelSets level_sets = LevelSets::refused);

/// The grid that a scene calls `name`, if it can be used as concentrations. Throws as grid_called,
/// and for level sets that are not to become fog, points, vectors, other types, and transforms that
/// are not affine.
const GridSummary& select_grid(const VdbHeader& header, const std::string& name,
                               const SourceLocation& where,
                               LevelSets level_sets = LevelSets::refused);

}  // namespace uw
