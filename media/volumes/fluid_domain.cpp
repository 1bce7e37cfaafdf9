#include "media/volumes/fluid_domain.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "media/volumes/vdb_header.h"

namespace uw {

namespace {

// The file is a gzip of 50 or 51 values of four bytes, little-endian: active fields, resolution
// (3), dx, dt, p0 (3), p1 (3), dp0 (3), shift (3), object shift (3), object matrix (16), domain's
// resolution (3), first (3) and last + 1 (3) voxel of the grids in it, colour (3), time, version.
constexpr std::size_t k_values = 50, k_resolution = 1, k_low = 6, k_high = 9, k_matrix = 21,
                      k_domain = 37, k_first = 40, k_end = 43, k_time = 49;

using ConfigValues = std::array<std::int32_t, k_values>;

std::filesystem::path config_of(const std::filesystem::path& data_file) {
    const std::string stem = data_file.stem().string();
    std::size_t begin = stem.size();
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(stem[begin - 1])) != 0) --begin;
    if (begin == stem.size()) return {};
    return data_file.parent_path() / ".." / "config" / ("config_" + stem.substr(begin) + ".uni");
}

bool read_gzip(const std::filesystem::path& file, ConfigValues& values) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return false;
    admit_input(file, file.string(), "configuration of the fluid");
    const gzFile in = gzopen(file.c_str(), "rb");
    if (in == nullptr) return false;
    const int size = static_cast<int>(sizeof values);
    const bool is_whole = gzread(in, values.data(), static_cast<unsigned>(size)) == size;
    gzclose(in);
    return is_whole;
}

Vector3 reals_at(const ConfigValues& values, std::size_t first) {
    Vector3 v;
    for (int axis = 0; axis < 3; ++axis)
        v[axis] = static_cast<double>(
            std::bit_cast<float>(values[first + static_cast<std::size_t>(axis)]));
    return v;
}

/// Takes the domain's box over, which is given in the object's own axes and with its matrix.
void read_box(const ConfigValues& values, FluidConfig& config) {
    const Vector3 low = reals_at(values, k_low), high = reals_at(values, k_high);
    Matrix3 axes;  // of the domain in Blender's world, unit
    Vector3 sides;
    for (int axis = 0; axis < 3; ++axis) {
        const Vector3 column =
            reals_at(values, k_matrix + 4 * static_cast<std::size_t>(axis));  // of four rows
        const double length = glm::length(column);
        sides[axis] = length * (high[axis] - low[axis]);
        if (!(sides[axis] > 0) || !std::isfinite(sides[axis])) return;
        axes[axis] = column / length;
    }
    constexpr double k_flat = 1e-6;  // flatter ones are within the rounding of the file's floats
    if (!(std::abs(glm::determinant(axes)) > k_flat)) return;
    config.sides = sides;
    const Affine blender_from_object(
        Matrix3(sides.x / (high.x - low.x) * axes[0], sides.y / (high.y - low.y) * axes[1],
                sides.z / (high.z - low.z) * axes[2]),
        reals_at(values, k_matrix + 12));
    config.blender_from_domain =
        Affine(axes, from_origin(blender_from_object * at_origin_plus(low)));
}

}  // namespace

std::optional<FluidConfig> read_fluid_config(const std::filesystem::path& data_file) {
    ConfigValues values{};
    if (!read_gzip(config_of(data_file), values)) return std::nullopt;
    FluidConfig config;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        config.resolution[axis] = values[k_resolution + axis];
        config.domain[axis] = values[k_domain + axis];
        config.first[axis] = values[k_first + axis];
        const std::int64_t count = config.resolution[axis], first = config.first[axis];
        if (count <= 0 || first < 0 || first + count > config.domain[axis] ||
            first + count != values[k_end + axis])
            return std::nullopt;
    }
    read_box(values, config);
    config.time = static_cast<double>(std::bit_cast<float>(values[k_time]));
    return config;
}

std::vector<std::filesystem::path> files_named_by_volume(const std::filesystem::path& data_file) {
    const std::filesystem::path config = config_of(data_file);
    std::error_code error;
    if (!std::filesystem::is_regular_file(config, error)) return {};
    return {config};
}

namespace {

constexpr std::size_t k_max_neighbours = 8;

const GridSummary* grid_with_resolution(const VdbHeader& header) {
    const auto it = std::ranges::find_if(header.grids, [](const GridSummary& grid) {
        return grid.base_resolution && grid.voxel_edge;
    });
    return it == header.grids.end() ? nullptr : &*it;
}

/// The sequence that `file` is a frame of, by the number at the end of its name; "" without one.
std::filesystem::path sequence_of(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    std::size_t digits = 0;
    while (digits < stem.size() &&
           std::isdigit(static_cast<unsigned char>(stem[stem.size() - 1 - digits])) != 0)
        ++digits;
    if (digits == 0) return {};
    return file.parent_path() / (stem.substr(0, stem.size() - digits) + std::string(digits, '#') +
                                 file.extension().string());
}

/// Up to k_max_neighbours files, from the first to the last.
std::vector<std::filesystem::path> neighbours_of(const std::filesystem::path& file) {
    const std::filesystem::path sequence = sequence_of(file);
    if (sequence.empty()) return {};
    const std::vector<int> frames = frames_found(sequence);
    const std::size_t count = std::min(frames.size(), k_max_neighbours);
    std::vector<std::filesystem::path> files;
    for (std::size_t n = 0; n < count; ++n)
        files.push_back(file_of_frame(
            sequence, frames[count == 1 ? 0 : n * (frames.size() - 1) / (count - 1)]));
    return files;
}

/// The domain of a grid by the cache's configuration. Its voxels may be finer by a whole factor (as
/// those of noise are); empty if the configuration belongs to other grids.
std::optional<FluidDomain> domain_of(const FluidConfig& config, const GridSummary& grid) {
    FluidDomain domain;
    const std::int32_t finer = (*grid.base_resolution)[0] / config.resolution[0];
    Vector3 voxels;  // of the domain
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (finer < 1 || (*grid.base_resolution)[axis] != finer * config.resolution[axis])
            return std::nullopt;
        voxels[static_cast<int>(axis)] = static_cast<double>(finer) * config.domain[axis];
    }
    domain.is_adaptive = config.resolution != config.domain;
    domain.longest_side = *grid.voxel_edge * std::ranges::max(*grid.base_resolution);
    if (!(domain.longest_side > 0) || !std::isfinite(domain.longest_side)) return std::nullopt;
    domain.max_voxels = finer * std::ranges::max(config.domain);
    domain.voxel = Vector3(domain.max_voxel());
    domain.first =
        static_cast<double>(finer) * Vector3(config.first[0], config.first[1], config.first[2]);
    // The solver knows the object's own scale, but not that of its parents, which the box has.
    if (config.blender_from_domain) {
        domain.longest_side = std::max({config.sides.x, config.sides.y, config.sides.z});
        domain.voxel = config.sides / voxels;
        domain.blender_from_domain = config.blender_from_domain;
    }
    return domain;
}

}  // namespace

std::optional<double> fluid_frame_rate(const std::filesystem::path& data_file) {
    constexpr double k_solver_seconds = 0.4;  // its step at 25 frames a second is 0.1
    std::optional<double> last_time;
    int last_frame = 0;
    const std::filesystem::path sequence = sequence_of(data_file);
    if (sequence.empty() || !read_fluid_config(data_file)) return std::nullopt;
    for (const int frame : frames_found(sequence)) {
        const auto config = read_fluid_config(file_of_frame(sequence, frame));
        if (!config) continue;
        if (last_time && config->time > *last_time) {
            const double rate =
                (frame - last_frame) / (k_solver_seconds * (config->time - *last_time));
            constexpr double k_rounding = 1e-3;  // of the file's floats
            const double whole = std::round(rate);
            return std::abs(rate - whole) < k_rounding * rate ? whole : rate;
        }
        last_time = config->time;
        last_frame = frame;
    }
    return std::nullopt;
}

std::string FluidDomain::description() const {
    constexpr const char* k_cause =
        "it was baked with Blender's 'Adaptive Domain' (Physics > Fluid > Settings), whose files "
        "hold a wrong voxel size, a different one in each frame";
    if (voxel)
        return fmt::format(
            "{}: {:.4g} x {:.4g} x {:.4g} m and the place of each frame in the domain are taken "
            "from the cache's folder config",
            k_cause, voxel->x, voxel->y, voxel->z);
    return fmt::format(
        "{0}: keep the cache's folder config beside data; or give the volume as voxel_size the "
        "length of the domain's longest side, {1:.4g} m, divided by its Resolution Divisions (at "
        "least {2}, so voxel_size: {3:.4g} or less); or bake without that checkbox, as the place "
        "in the domain is lost, too",
        k_cause, longest_side, max_voxels, max_voxel());
}

std::optional<FluidDomain> find_fluid_domain(const VdbHeader& header) {
    if (!header.from_blender_fluid()) return std::nullopt;
    const GridSummary* const grid = grid_with_resolution(header);
    if (grid == nullptr) return std::nullopt;
    if (const auto config = read_fluid_config(header.file)) {
        if (const auto known = domain_of(*config, *grid)) return known;
        if (config->resolution == config->domain) return std::nullopt;
    }
    FluidDomain domain;
    domain.is_adaptive = true;
    domain.max_voxels = std::ranges::max(*grid->base_resolution);
    domain.longest_side = *grid->voxel_edge * domain.max_voxels;
    bool differs = false;
    for (const std::filesystem::path& file : neighbours_of(header.file)) {
        VdbHeader other;
        try {
            other = read_vdb_header(file, file.string());
        } catch (const std::runtime_error&) {
            continue;  // a neighbour that cannot be read is ignored
        }
        const GridSummary* const its = grid_with_resolution(other);
        if (its == nullptr || its->name != grid->name) continue;
        differs = differs || its->base_resolution != grid->base_resolution;
        domain.max_voxels = std::max(domain.max_voxels, std::ranges::max(*its->base_resolution));
    }
    if (!differs || !(domain.longest_side > 0) || !std::isfinite(domain.longest_side))
        return std::nullopt;
    return domain;
}

Affine with_voxel_size(const Affine& file_from_index, const VolumeDesc& desc,
                       const std::optional<FluidDomain>& domain) {
    const Matrix3& m = file_from_index.linear();
    const Vector3 edges(glm::length(m[0]), glm::length(m[1]), glm::length(m[2]));
    std::optional<Vector3> voxel;
    if (desc.voxel_size) {
        constexpr double k_rounding = 1e-4;
        for (int axis = 1; axis < 3; ++axis)
            if (!(std::abs(edges[axis] - edges[0]) <= k_rounding * edges[0]))
                throw InputError(fmt::format(
                    "{}: voxel_size: is for voxels that are cubes; those of '{}' have edges of "
                    "{:g}, {:g} and {:g} m: use transform.scale",
                    desc.where, desc.file.string(), edges.x, edges.y, edges.z));
        voxel = Vector3(*desc.voxel_size);
    } else if (domain) {
        voxel = domain->voxel;
    }
    if (!voxel) return file_from_index;
    const Affine place = Affine::translation(domain ? domain->first : Vector3(0));
    return Affine::scale(*voxel / edges) * file_from_index * place;
}

}  // namespace uw
