#include "media/volumes/vdb_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"

namespace uw {

bool VdbHeader::from_blender_fluid() const {
    if (!creator.empty() || grids.empty()) return false;
    const auto has_mark = [](const GridSummary& grid) { return grid.base_resolution.has_value(); };
    if (std::any_of(grids.begin(), grids.end(), has_mark)) return true;
    constexpr std::string_view k_noise = "_noise";
    static constexpr std::array<std::string_view, 13> names{
        "velocity", "density", "shadow", "temperature", "heat",  "flame",   "color_r",
        "color_g",  "color_b", "fuel",   "react",       "flags", "pressure"};
    bool telling = false;  // a name that no other program uses besides "density"
    for (const GridSummary& grid : grids) {
        std::string_view name = grid.base_name;
        const bool noise = name.ends_with(k_noise);
        if (noise) name.remove_suffix(k_noise.size());
        telling |= noise || name == "shadow";
        const bool known = std::find(names.begin(), names.end(), name) != names.end();
        if (!known && !name.starts_with("phi_")) return false;
    }
    return telling;
}

bool VdbHeader::from_embergen() const {
    if (creator.find("EmberGen") != std::string::npos) return true;
    return std::ranges::any_of(grids, [this](const GridSummary& grid) {
        return grid.from_embergen || (creator.empty() && grid.base_name == "flames");
    });
}

bool VdbHeader::from_houdini() const {
    return creator.find("Houdini") != std::string::npos ||
           creator.find("GEO_VDB") != std::string::npos;
}

std::string VdbHeader::describe_grids() const {
    if (grids.empty()) return "no grids";
    std::string list;
    constexpr std::size_t most = 24;
    for (std::size_t i = 0; i < std::min(grids.size(), most); ++i)
        list += fmt::format("{}{} ({}{}, {})", i == 0 ? "" : ", ", grids[i].name,
                            grids[i].half ? "half " : "", grids[i].value_type, grids[i].grid_class);
    if (grids.size() > most) list += fmt::format(" and {} more", grids.size() - most);
    return list;
}

ByteReader::ByteReader(const std::filesystem::path& file, const SourceLocation& where)
    : file_(file),
      where_(where),
      stream_(open_input(file, fmt::format("{}: '{}'", where, file.string()), "volume")) {
    size_ = static_cast<std::int64_t>(std::filesystem::file_size(file));
}

void ByteReader::fail(const std::string& what) const {
    throw InputError(fmt::format("{}: '{}' {}", where_, file_.string(), what));
}

void ByteReader::fail_damaged() const {
    fail("is truncated or damaged; copy or export it again");
}

void ByteReader::seek(std::int64_t position) {
    if (position < 0 || position > size_) fail_damaged();
    position_ = position;
}

void ByteReader::skip(std::int64_t bytes) {
    if (bytes < 0 || bytes > size_ - position_) fail_damaged();
    position_ += bytes;
}

void ByteReader::read(char* to, std::size_t bytes) {
    const auto wanted = static_cast<std::int64_t>(bytes);
    if (wanted > size_ - position_) fail_damaged();
    const std::int64_t window_end = window_begin_ + static_cast<std::int64_t>(window_.size());
    if (position_ < window_begin_ || position_ + wanted > window_end) {
        constexpr std::int64_t k_window_bytes = 1 << 16;
        const std::int64_t length = std::min(std::max(k_window_bytes, wanted), size_ - position_);
        window_.resize(static_cast<std::size_t>(length));
        stream_.seekg(position_);
        stream_.read(window_.data(), length);
        if (!stream_) fail_damaged();
        window_begin_ = position_;
    }
    std::memcpy(to, window_.data() + (position_ - window_begin_), bytes);
    position_ += wanted;
}

std::string ByteReader::text(std::size_t size) {
    if (size > k_longest_text) fail("is damaged: it contains an absurdly long name");
    std::string value(size, '\0');
    read(value.data(), size);
    return value;
}

namespace {

/// Names come from the file and appear in one-line messages.
std::string replace_controls(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
    return text;
}

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

void set_nano_type(GridSummary& grid, std::uint32_t type, std::uint32_t grid_class) {
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

GridSummary read_nano_grid(ByteReader& in, std::uint16_t codec) {
    const auto metadata = in.get<NanoMetadata>();
    const auto fits = [&](std::uint64_t bytes) {
        return bytes <= static_cast<std::uint64_t>(in.size());
    };
    constexpr std::uint64_t k_max_packing = 4096;  // no codec compresses better than that
    if (!fits(metadata.stored_bytes) || metadata.grid_bytes / k_max_packing > metadata.stored_bytes)
        in.fail_damaged();
    if (codec == 0 && metadata.grid_bytes != metadata.stored_bytes) in.fail_damaged();
    GridSummary grid;
    const std::string name = in.text(metadata.name_bytes);
    grid.base_name = replace_controls(name.substr(0, name.find('\0')));
    grid.name = grid.unique_name = grid.base_name;
    set_nano_type(grid, metadata.type, metadata.grid_class);
    grid.compression = codec == 2 ? 4U : codec;  // as in VDB files
    grid.map_type = "AffineMap";
    grid.active_voxels = static_cast<std::int64_t>(metadata.active_voxels & ~(1ULL << 63U));
    const auto& box = metadata.index_box;
    grid.active_box = IndexBox{{box[0], box[1], box[2]}, {box[3], box[4], box[5]}};
    grid.stored_bytes = static_cast<std::int64_t>(metadata.stored_bytes);
    grid.grid_bytes = static_cast<std::int64_t>(metadata.grid_bytes);
    return grid;
}

/// Numbers grids that share a name, as in VDB files, and those that have none.
void number_namesakes(std::vector<GridSummary>& grids) {
    std::map<std::string, int> count, next;
    for (const GridSummary& grid : grids) ++count[grid.base_name];
    for (GridSummary& grid : grids)
        if (count[grid.base_name] > 1 || grid.base_name.empty())
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
    for (std::uint16_t n = 0; n < count; ++n) header.grids.push_back(read_nano_grid(in, codec));
    for (std::size_t n = first; n < header.grids.size(); ++n) {
        header.grids[n].blocks_offset = in.position();
        in.skip(header.grids[n].stored_bytes);
    }
}

/// Whether a file that begins with these 8 bytes is NanoVDB's.
bool is_nvdb_magic(std::int64_t magic) {
    return magic == k_magic_0 || magic == k_magic_1 || magic == k_magic_2;
}

/// The header of a NanoVDB file: all its segments and the metadata of its grids. Throws InputError
/// as read_vdb_header does.
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

constexpr std::int64_t k_magic = 0x56444220;
constexpr std::uint32_t k_oldest_version = 220, k_newest_version = 224;

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

template <class Value>
std::optional<Value> value_of(const std::map<std::string, Value>& values, const char* name) {
    const auto found = values.find(name);
    return found == values.end() ? std::nullopt : std::optional(found->second);
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
    grid.name = grid.base_name.empty() ? "[0]" : grid.base_name;
    if (separator != std::string::npos)
        grid.name = fmt::format("{}[{}]", grid.base_name,
                                replace_controls(unique_name.substr(separator + 1)));
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
    if (end < in.position() || end > in.size() || grid_offset < in.position() || grid_offset > end)
        in.fail_damaged();

    in.seek(grid_offset);
    grid.compression = header.version >= 222 ? in.get<std::uint32_t>() : 0;
    const Metadata metadata = read_metadata(in);
    if (const auto grid_class = value_of(metadata.strings, "class"))
        grid.grid_class = replace_controls(*grid_class);
    grid.active_voxels = value_of(metadata.integers, "file_voxel_count");
    const auto low = value_of(metadata.vectors, "file_bbox_min");
    const auto high = value_of(metadata.vectors, "file_bbox_max");
    if (low && high) grid.active_box = IndexBox{*low, *high};
    grid.base_resolution = value_of(metadata.vectors, "file_base_resolution");
    grid.from_embergen = metadata.has("embergen_version");
    grid.transform_offset = in.position();
    grid.map_type = replace_controls(in.text());
    if (grid.map_type == "UniformScaleMap") grid.voxel_edge = in.get<double>();
    in.seek(end);
    return grid;
}

void check_version(const ByteReader& in, const VdbHeader& header) {
    if (header.version > k_newest_version)
        in.fail(fmt::format(
            "is a VDB file of version {}, written by OpenVDB {}.{}; this build reads up to version "
            "{}: save it with OpenVDB 12 or older, with 32-bit floats",
            header.version, header.library_major, header.library_minor, k_newest_version));
    if (header.version < k_oldest_version)
        in.fail(
            fmt::format("is a VDB file of version {}, from before OpenVDB 1.0; this build reads "
                        "versions {} to {}: save it with a newer program",
                        header.version, k_oldest_version, k_newest_version));
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

namespace {

std::string did_you_mean(const VdbHeader& header, const std::string& name) {
    std::vector<std::string_view> names;
    for (const GridSummary& grid : header.grids) {
        names.emplace_back(grid.name);
        names.emplace_back(grid.base_name);
    }
    const std::string_view near = nearest_word(name, names);
    if (near.empty()) return "";
    // The first of the grids that share a base name.
    const auto grid = std::ranges::find_if(header.grids, [&](const GridSummary& candidate) {
        return candidate.name == near || candidate.base_name == near;
    });
    return fmt::format("; did you mean '{}'?", grid->name);
}

}  // namespace

std::string unusable_because(const GridSummary& grid, LevelSets level_sets) {
    if (grid.value_type.starts_with("ptdataidx") || grid.value_type.starts_with("ptidx"))
        return "holds points, not a concentration; rasterise them to a fog volume first";
    if (grid.value_type.starts_with("vec"))
        return fmt::format("holds vectors ({}); name a grid with one number per voxel",
                           grid.value_type);
    if (grid.tree_type != "Tree_float_5_4_3" && grid.tree_type != "Tree_double_5_4_3")
        return fmt::format(
            "has values of type {}; concentrations are float or double{}", grid.value_type,
            grid.tree_type.empty() ? ", or in NanoVDB also fp4, fp8, fp16 and fpN" : "");
    if (grid.grid_class == "level set" && level_sets == LevelSets::refused)
        return "is a level set (distances to a surface), not a concentration; give its volume "
               "level_set: fog, which fills its inside, or write {file, grid} under geometry, "
               "which "
               "shows its surface";
    if (grid.map_type == "NonlinearFrustumMap")
        return "has a frustum (camera-shaped) transform; resample it to an affine one";
    return "";
}

namespace {

[[noreturn]] void refuse_grid(const VdbHeader& header, const SourceLocation& where,
                              const std::string& why) {
    throw InputError(fmt::format("{}: {} ('{}' has {})", where, why, header.file.string(),
                                 header.describe_grids()));
}

}  // namespace

const GridSummary& grid_called(const VdbHeader& header, const std::string& name,
                               const SourceLocation& where) {
    const GridSummary* found = nullptr;
    int namesakes = 0;
    for (const GridSummary& grid : header.grids)
        if (grid.name == name || grid.base_name == name) {
            if (namesakes++ == 0) found = &grid;
        }
    if (namesakes == 0)
        refuse_grid(header, where, fmt::format("no grid '{}'{}", name, did_you_mean(header, name)));
    if (namesakes > 1)
        refuse_grid(header, where,
                    fmt::format("{} grids are called '{}'; write '{}' for the first", namesakes,
                                name, found->name));
    return *found;
}

const GridSummary& select_grid(const VdbHeader& header, const std::string& name,
                               const SourceLocation& where, LevelSets level_sets) {
    const GridSummary& grid = grid_called(header, name, where);
    const std::string why = unusable_because(grid, level_sets);
    if (!why.empty()) refuse_grid(header, where, fmt::format("grid '{}' {}", grid.name, why));
    return grid;
}

}  // namespace uw
