#include "media/vdb/vdb_header_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "core/files/pointer_file.h"
#include "media/vdb/byte_reader.h"
#include "media/vdb/nvdb_header.h"

namespace uw {
namespace {

constexpr std::int64_t k_magic = 0x56444220;

/// Names come from the file and appear in one-line messages.
std::string replace_controls(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return text;
}

/// A metadata map: strings, 64-bit integers and 3-vectors by name; for other types only the name.
struct Metadata {
    std::map<std::string, std::string> strings;
    std::map<std::string, std::int64_t> integers;
    std::map<std::string, std::array<std::int32_t, 3>> vectors;
    std::vector<std::string> others;

    bool has(const std::string& name) const {
        return strings.contains(name) || integers.contains(name) || vectors.contains(name) ||
               std::ranges::find(others, name) != others.end();
    }
};

Metadata read_metadata(ByteReader& in) {
    Metadata metadata;
    const auto count = in.get<std::uint32_t>();
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string name = in.text();
        const std::string type = in.text();
        const auto size = in.get<std::uint32_t>();
        if (type == "string" && size <= ByteReader::k_longest_text) {
            metadata.strings[name] = in.text(size);
        } else if (type == "int64" && size == sizeof(std::int64_t)) {
            metadata.integers[name] = in.get<std::int64_t>();
        } else if (type == "vec3i" && size == 3 * sizeof(std::int32_t)) {
            metadata.vectors[name] = in.get<std::array<std::int32_t, 3>>();
        } else {
            metadata.others.push_back(name);
            in.skip(size);
        }
    }
    return metadata;
}

bool take_suffix(std::string& text, const std::string& suffix) {
    if (!text.ends_with(suffix)) return false;
    text.resize(text.size() - suffix.size());
    return true;
}

/// Grids that share a name are distinguished in the file by a number after the character "record
/// separator".
void set_names(GridSummary& grid, const std::string& unique_name) {
    grid.unique_name = unique_name;
    const auto separator = unique_name.rfind('\x1e');
    grid.base_name = replace_controls(unique_name.substr(0, separator));
    grid.name = grid.base_name;
    if (separator != std::string::npos)
        grid.name += fmt::format("[{}]", replace_controls(unique_name.substr(separator + 1)));
}

void set_type(GridSummary& grid, std::string type) {
    grid.half = take_suffix(type, "_HalfFloat");
    grid.tree_type = replace_controls(type);
    grid.value_type = grid.tree_type;
    if (grid.value_type.starts_with("Tree_")) grid.value_type.erase(0, 5);
    take_suffix(grid.value_type, "_5_4_3");
}

GridSummary read_grid(ByteReader& in, const VdbHeader& header) {
    GridSummary grid;
    set_names(grid, in.text());
    set_type(grid, in.text());
    grid.instance_of = in.text();
    const auto grid_offset = in.get<std::int64_t>();
    grid.blocks_offset = in.get<std::int64_t>();
    const auto end = in.get<std::int64_t>();
    const std::int64_t next_descriptor = end;
    if (end < in.position() || end > in.size() || grid_offset < in.position() || grid_offset > end)
        in.fail("is truncated or damaged; copy or export it again");

    in.seek(grid_offset);
    grid.compression = header.version >= 222 ? in.get<std::uint32_t>() : 0;
    const Metadata metadata = read_metadata(in);
    if (const auto it = metadata.strings.find("class"); it != metadata.strings.end())
        grid.grid_class = replace_controls(it->second);
    if (const auto it = metadata.integers.find("file_voxel_count"); it != metadata.integers.end())
        grid.active_voxels = it->second;
    const auto low = metadata.vectors.find("file_bbox_min");
    const auto high = metadata.vectors.find("file_bbox_max");
    if (low != metadata.vectors.end() && high != metadata.vectors.end())
        grid.active_box = IndexBox{low->second, high->second};
    if (const auto it = metadata.vectors.find("file_base_resolution"); it != metadata.vectors.end())
        grid.base_resolution = it->second;
    grid.from_embergen = metadata.has("embergen_version");
    grid.transform_offset = in.position();
    grid.map_type = replace_controls(in.text());
    if (grid.map_type == "UniformScaleMap") grid.voxel_edge = in.get<double>();
    in.seek(next_descriptor);
    return grid;
}

void check_version(const ByteReader& in, const VdbHeader& header) {
    if (header.version > k_newest_vdb_version)
        in.fail(fmt::format(
            "is a VDB file of version {}, written by OpenVDB {}.{}; this build reads up to version "
            "{}: save it with OpenVDB 12 or older, with 32-bit floats",
            header.version, header.library_major, header.library_minor, k_newest_vdb_version));
    if (header.version < k_oldest_vdb_version)
        in.fail(
            fmt::format("is a VDB file of version {}, from before OpenVDB 1.0; this build reads "
                        "versions {} to {}: save it with a newer program",
                        header.version, k_oldest_vdb_version, k_newest_vdb_version));
}

}  // namespace

VdbHeader read_vdb_header(const std::filesystem::path& file, const SourceLocation& where) {
    ByteReader in(file, where);
    VdbHeader header;
    header.file = file;
    const std::int64_t magic = in.size() < 8 ? 0 : in.get<std::int64_t>();
    if (is_nvdb_magic(magic)) return read_nvdb_header(in, file);
    if (magic != k_magic) {
        const std::string stand_in = stand_in_of(file);
        in.fail(stand_in.empty() ? "is not a VDB file (it does not start like one)" : stand_in);
    }
    header.version = in.get<std::uint32_t>();
    header.library_major = in.get<std::uint32_t>();
    header.library_minor = in.get<std::uint32_t>();
    check_version(in, header);
    const bool has_offsets = in.get<char>() != 0;
    std::uint32_t compression = 0;
    if (header.version < 222) compression = in.get<char>() != 0 ? 1 : 0;
    in.skip(36);  // UUID as text
    Metadata metadata = read_metadata(in);
    header.creator = replace_controls(metadata.strings["creator"]);
    if (!has_offsets)
        in.fail("was written as a stream, without offsets; save it with openvdb::io::File");
    const auto count = in.get<std::int32_t>();
    for (std::int32_t i = 0; i < count; ++i) {
        GridSummary grid = read_grid(in, header);
        if (header.version < 222) grid.compression = compression;
        header.grids.push_back(std::move(grid));
    }
    return header;
}

}  // namespace uw
