#include "media/vdb/nvdb_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

namespace uw {
namespace {

// "NanoVDB0" up to library 32.5, then "NanoVDB1" for grids and "NanoVDB2" for files.
constexpr std::int64_t k_magic_0 = 0x304244566f6e614e, k_magic_1 = 0x314244566f6e614e,
                       k_magic_2 = 0x324244566f6e614e;
constexpr std::uint32_t k_major_version =
    32;                                    // of the memory layout, which is also the file layout
constexpr std::uint16_t k_last_codec = 2;  // 0 none, 1 zip, 2 blosc

/// A segment's metadata for one grid, in the file's layout.
struct NanoMetadata {
    std::uint64_t grid_bytes = 0, stored_bytes = 0, name_key = 0, active_voxels = 0;
    std::uint32_t type = 0, grid_class = 0;
    std::array<double, 6> world_box{};
    std::array<std::int32_t, 6> index_box{};
    std::array<double, 3> voxel_size{};
    std::uint32_t name_bytes = 0;
    std::array<std::uint32_t, 4> node_count{};
    std::array<std::uint32_t, 3> tile_count{};
    std::uint16_t codec = 0, padding = 0;
    std::uint32_t version = 0;
};
static_assert(sizeof(NanoMetadata) == 176);

void set_type(GridSummary& grid, std::uint32_t type, std::uint32_t grid_class) {
    static constexpr std::array<const char*, 20> names{
        "unknown", "float", "double", "int16",  "int32", "int64", "vec3s",
        "vec3d",   "mask",  "half",   "uint32", "bool",  "rgba8", "fp4",
        "fp8",     "fp16",  "fpN",    "vec4f",  "vec4d", "index"};
    grid.value_type = type < names.size() ? names[type] : fmt::format("number {}", type);
    if (grid.value_type.starts_with("fp")) {
        grid.quantised = grid.value_type;
        grid.value_type = "float";
    }
    static constexpr std::array<const char*, 4> classes{"unknown", "level set", "fog volume",
                                                        "staggered"};
    grid.grid_class = grid_class < classes.size() ? classes[grid_class] : "unknown";
    constexpr std::uint32_t point_index = 4, point_data = 5;
    if (grid_class == point_index || grid_class == point_data) grid.value_type = "ptidx32";
    if (grid.value_type == "float" || grid.value_type == "double")
        grid.tree_type = "Tree_" + grid.value_type + "_5_4_3";
}

std::string name_of(ByteReader& in, std::uint32_t bytes) {
    std::string name = in.text(bytes);
    name.resize(std::min(name.size(), name.find('\0')));
    std::ranges::replace_if(
        name, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return name;
}

GridSummary read_metadata(ByteReader& in, std::uint16_t codec) {
    const auto metadata = in.get<NanoMetadata>();
    const auto fits = [&](std::uint64_t bytes) {
        return bytes <= static_cast<std::uint64_t>(in.size());
    };
    constexpr std::uint64_t k_most_packing = 4096;  // no codec compresses better than that
    if (!fits(metadata.stored_bytes) ||
        metadata.grid_bytes / k_most_packing > metadata.stored_bytes)
        in.fail("is truncated or damaged; copy or export it again");
    if (codec == 0 && metadata.grid_bytes != metadata.stored_bytes) in.fail_damaged();
    GridSummary grid;
    grid.base_name = name_of(in, metadata.name_bytes);
    grid.name = grid.unique_name = grid.base_name;
    set_type(grid, metadata.type, metadata.grid_class);
    grid.compression = codec == 2 ? 4U : codec;  // as in VDB files
    grid.map_type = "AffineMap";
    grid.active_voxels = static_cast<std::int64_t>(metadata.active_voxels & ~(1ULL << 63U));
    const auto& box = metadata.index_box;
    grid.active_box = IndexBox{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
    grid.stored_bytes = static_cast<std::int64_t>(metadata.stored_bytes);
    grid.grid_bytes = static_cast<std::int64_t>(metadata.grid_bytes);
    return grid;
}

/// Numbers grids that share a name, as in VDB files.
void number_namesakes(std::vector<GridSummary>& grids) {
    std::map<std::string, int> count, next;
    for (const GridSummary& grid : grids) ++count[grid.base_name];
    for (GridSummary& grid : grids)
        if (count[grid.base_name] > 1)
            grid.name = fmt::format("{}[{}]", grid.base_name, next[grid.base_name]++);
}

void read_segment(ByteReader& in, VdbHeader& header) {
    const auto version = in.get<std::uint32_t>();
    header.library_major = version >> 21U;
    header.library_minor = (version >> 10U) & 0x7ffU;
    if (header.library_major != k_major_version)
        in.fail(
            fmt::format("is a NanoVDB file of version {}.{}; this build reads version {}: convert "
                        "it again from the VDB file, or use the VDB file itself",
                        header.library_major, header.library_minor, k_major_version));
    const auto count = in.get<std::uint16_t>();
    const auto codec = in.get<std::uint16_t>();
    if (codec > k_last_codec) in.fail_damaged();
    const std::size_t first = header.grids.size();
    for (std::uint16_t n = 0; n < count; ++n) header.grids.push_back(read_metadata(in, codec));
    for (std::size_t n = first; n < header.grids.size(); ++n) {
        header.grids[n].blocks_offset = in.position();
        in.skip(header.grids[n].stored_bytes);
    }
}

}  // namespace

bool is_nvdb_magic(std::int64_t magic) {
    return magic == k_magic_0 || magic == k_magic_1 || magic == k_magic_2;
}

VdbHeader read_nvdb_header(ByteReader& in, const std::filesystem::path& file) {
    VdbHeader header;
    header.file = file;
    header.is_nano = true;
    in.seek(0);
    while (in.position() < in.size()) {
        const auto magic = in.get<std::int64_t>();
        if (magic == k_magic_1)
            in.fail(
                "holds a bare NanoVDB grid, without a file header; write it with "
                "nanovdb::io::writeGrid");
        if (!is_nvdb_magic(magic)) in.fail_damaged();
        read_segment(in, header);
    }
    number_namesakes(header.grids);
    return header;
}

}  // namespace uw
