#include "media/volumes/load_volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/scene_limits.h"
#include "media/volumes/fluid_domain.h"
#include "media/volumes/grid_field.h"
#include "media/volumes/vdb_file.h"
#include "media/volumes/vdb_header.h"

namespace uw {

namespace {

// The largest value of a grid, and the largest concentration that it may mean [ppm, or units of its
// own coefficients].
constexpr double k_max_value = 1e30, k_max_concentration = 1e12;
constexpr double k_min_voxel = 1e-9;  // m

/// Integrals along the world's axes through the centre of `bounds`.
std::array<double, 3> columns_through_middle(const GridVolume& volume) {
    std::array<double, 3> columns{};
    if (volume.bricks().empty()) return columns;
    for (int axis = 0; axis < 3; ++axis) {
        Point3 a = volume.bounds().center(), b = a;
        a[axis] = volume.bounds().min[axis];
        b[axis] = volume.bounds().max[axis];
        columns[static_cast<std::size_t>(axis)] = volume.column(a, b);
    }
    return columns;
}

VolumeReport report_on(const VolumeDesc& desc, const LoadedGrid& loaded, const GridVolume& volume,
                       const Placement& placement) {
    VolumeReport report;
    report.file = desc.file;
    report.grid = loaded.name;
    report.metres_per_voxel = volume.voxel_size();
    report.bounds = volume.voxel_bounds();
    report.placement = placement;
    report.statistics = loaded.statistics;
    report.column = columns_through_middle(volume);
    report.bricks = volume.bricks().size();
    for (const NanoGrid& brick : volume.bricks()) report.bytes += brick.bytes();
    for (const GridLoad& load : volume.loads()) {
        ConstituentReport part;
        part.constituent = load.constituent;
        part.min = load.per_unit * loaded.statistics.min;
        part.mean = load.per_unit * loaded.statistics.mean;
        part.max = load.per_unit * loaded.statistics.max;
        for (std::size_t axis = 0; axis < 3; ++axis)
            part.column[axis] = load.per_unit * report.column[axis];
        report.constituents.push_back(part);
    }
    return report;
}

// Checks that rays can be traced to the volume and that sums along them cannot overflow.
void check_limits(const VolumeReport& report, const VolumeDesc& desc,
                  const GridMappingDesc& mapping) {
    for (int axis = 0; axis < 3; ++axis)
        if (!report.bounds.empty() && !(report.bounds.min[axis] >= -k_max_coordinate &&
                                        report.bounds.max[axis] <= k_max_coordinate))
            throw InputError(fmt::format("{}: grid '{}' extends beyond {:g} m; check its transform",
                                         desc.where, printable(report.grid), k_max_coordinate));
    const Vector3& voxel = report.metres_per_voxel;
    if (!(std::min({voxel.x, voxel.y, voxel.z}) >= k_min_voxel))
        throw InputError(
            fmt::format("{}: grid '{}' has voxels of {:g} x {:g} x {:g} m; scale it to "
                        "metres by its transform",
                        desc.where, printable(report.grid), voxel.x, voxel.y, voxel.z));
    double largest = 0;
    for (const ConstituentReport& part : report.constituents) largest = std::max(largest, part.max);
    if (!(report.statistics.max <= k_max_value && largest <= k_max_concentration))
        throw InputError(fmt::format(
            "{}: the largest value of grid '{}', {:g}, makes a concentration of {:g}: over {:g}, "
            "or values over {:g}, are no water; check the file (uwvdb info) and the mapping",
            mapping.where, printable(report.grid), report.statistics.max, largest,
            k_max_concentration, k_max_value));
}

/// The linear map of lengths in a grid's file to those in the world.
Matrix3 world_from_file(const VdbHeader& header, const VolumeDesc& desc,
                        const GridMappingDesc& mapping, const Placement& placement,
                        const std::optional<FluidDomain>& domain) {
    LoadedGrid grid;
    const Affine file_from_index =
        read_file_from_index(header, mapping.grid, mapping.where, desc.level_sets);
    grid.file_from_index = with_voxel_size(file_from_index, desc, domain);
    return world_from_index(grid, placement, desc.world_from_upright).linear() *
           file_from_index.inverse().linear();
}

// Adds the next grid of a volume. Its file_from_index is that of where it lies in its file.
void add_grid(LoadedGrid loaded, const VolumeDesc& desc, const Placement& placement,
              const std::vector<GridLoad>& loads, LoadedVolume& volume) {
    const GridMappingDesc& mapping = desc.grids[volume.grids.size()];
    const Affine place = world_from_index(loaded, placement, desc.world_from_upright);
    const double determinant = place.determinant();
    if (!std::isfinite(determinant) || determinant == 0)
        throw InputError(desc.where + ": its transform collapses the volume");
    volume.grids.emplace_back(std::move(loaded.bricks), place, placement.centering, loads);
    volume.reports.push_back(report_on(desc, loaded, volume.grids.back(), placement));
    check_limits(volume.reports.back(), desc, mapping);
}

LoadedVolume load_grids(const VolumeDesc& desc, const std::vector<std::vector<GridLoad>>& loads,
                        std::size_t slab_bytes,
                        const std::optional<EmissionDesc::Stimulus>& stimulus) {
    LoadedVolume volume;
    if (desc.grids.empty()) return volume;  // it only emits light
    if (desc.array) {
        volume.warnings = desc.array->warnings;
        add_grid(*desc.array, desc, {Centering::node, UpAxis::y}, loads.at(0), volume);
        return volume;
    }
    const VdbHeader header = read_vdb_header(desc.file, desc.where);
    const Placement placement = decide_placement(header, desc);
    const std::optional<FluidDomain> domain = find_fluid_domain(header);
    if (domain && domain->is_adaptive && !domain->voxel && !desc.voxel_size)
        volume.warnings.push_back(
            fmt::format("{}: '{}': {}", desc.where, desc.file.string(), domain->description()));
    for (std::size_t g = 0; g < desc.grids.size(); ++g) {
        const GridMappingDesc& mapping = desc.grids[g];
        std::optional<StimulatedLight> light;
        if (stimulus)
            light = {*stimulus, world_from_file(header, desc, mapping, placement, domain)};
        LoadedGrid loaded =
            light || (desc.motion && desc.motion->shutter > 0)
                ? load_moving_grid(header, mapping.grid, mapping.where, desc.motion.value(),
                                   placement.centering, desc.level_sets, light)
                : load_grid(header, mapping.grid, mapping.where, slab_bytes, desc.level_sets);
        volume.warnings.insert(volume.warnings.end(), loaded.warnings.begin(),
                               loaded.warnings.end());
        loaded.file_from_index = with_voxel_size(loaded.file_from_index, desc, domain);
        add_grid(std::move(loaded), desc, placement, loads.at(g), volume);
    }
    return volume;
}

}  // namespace

LoadedVolume load_volume(const VolumeDesc& desc, const std::vector<std::vector<GridLoad>>& loads,
                         std::size_t slab_bytes) {
    return load_grids(desc, loads, slab_bytes, {});
}

LoadedVolume load_light(const VolumeDesc& desc) {
    const EmissionDesc& emission = desc.emission.front();
    VolumeDesc of_light = desc;
    of_light.grids.assign(1, {});
    of_light.grids.front().grid = emission.grid;
    of_light.grids.front().where = emission.where;
    return load_grids(of_light, {{GridLoad{0, 1}}}, k_default_slab_bytes, emission.stimulus);
}

std::unique_ptr<ConcentrationField> load_volumes(
    const std::vector<VolumeDesc>& volumes,
    const std::vector<std::vector<std::vector<GridLoad>>>& loads, int constituent_count,
    std::vector<VolumeReport>& reports, std::vector<std::string>& warnings,
    std::size_t slab_bytes) {
    std::vector<GridVolume> grids;
    for (std::size_t v = 0; v < volumes.size(); ++v) {
        LoadedVolume volume = load_volume(volumes[v], loads.at(v), slab_bytes);
        grids.insert(grids.end(), volume.grids.begin(), volume.grids.end());
        reports.insert(reports.end(), volume.reports.begin(), volume.reports.end());
        warnings.insert(warnings.end(), volume.warnings.begin(), volume.warnings.end());
    }
    return std::make_unique<GridField>(std::move(grids), constituent_count);
}

namespace {

// Programs may round the transforms of individual frames differently [voxels].
constexpr double k_tolerance = 1e-4;

bool same_place(const Affine& a, const Affine& b) {
    const double voxel = std::cbrt(std::abs(a.determinant()));
    double difference = glm::length(a.offset() - b.offset());
    for (int axis = 0; axis < 3; ++axis)
        difference = std::max(difference, glm::length(a.linear()[axis] - b.linear()[axis]));
    return difference <= k_tolerance * voxel;
}

std::string describe(const Affine& file_from_index) {
    const Matrix3& m = file_from_index.linear();
    const Vector3& origin = file_from_index.offset();
    return fmt::format("voxels of {:.6g} x {:.6g} x {:.6g} from ({:.6g}, {:.6g}, {:.6g})",
                       glm::length(m[0]), glm::length(m[1]), glm::length(m[2]), origin.x, origin.y,
                       origin.z);
}

}  // namespace

namespace {

/// Throws as grid_called and select_grid for grids of light and of velocity that are needed and not
/// there. `header`: that of the volume's file.
void check_other_grids(const VolumeDesc& frame, const VdbHeader& header) {
    bool needs_motion = frame.motion && frame.motion->shutter > 0;
    for (const EmissionDesc& emission : frame.emission) {
        select_grid(header, emission.grid, emission.where, frame.level_sets);
        needs_motion = needs_motion || emission.stimulus;
    }
    if (!needs_motion || !frame.motion) return;
    const bool is_beside = frame.motion->file == frame.file;
    const VdbHeader other =
        is_beside ? VdbHeader() : read_vdb_header(frame.motion->file, frame.motion->where);
    for (const std::string& name : frame.motion->grids)
        grid_called(is_beside ? header : other, name, frame.motion->where);
}

}  // namespace

void VolumeSequenceCheck::take(const VolumeDesc& frame) {
    const VdbHeader header = read_vdb_header(frame.file, frame.where);
    // Frames of an adaptive domain may lie at different places: each is moved to its own.
    std::optional<FluidDomain> domain = find_fluid_domain(header);
    if (domain) domain->first = Vector3(0);
    std::vector<Affine> transforms;
    for (const GridMappingDesc& mapping : frame.grids)
        transforms.push_back(with_voxel_size(
            read_file_from_index(header, mapping.grid, mapping.where, frame.level_sets), frame,
            domain));
    check_other_grids(frame, header);
    if (transforms_.empty()) {
        first_ = frame;
        transforms_ = std::move(transforms);
        return;
    }
    for (std::size_t g = 0; g < transforms.size(); ++g) {
        if (same_place(transforms_.at(g), transforms[g])) continue;
        if (domain && domain->is_adaptive)
            throw InputError(fmt::format("{}: '{}': {}", frame.grids[g].where, frame.file.string(),
                                         domain->description()));
        throw InputError(
            fmt::format("{}: grid '{}' of '{}' has {}, but that of '{}' has {}; export all frames "
                        "with one transform, or render them in separate runs",
                        frame.grids[g].where, frame.grids[g].grid, frame.file.string(),
                        describe(transforms[g]), first_.file.string(), describe(transforms_[g])));
    }
}

namespace {

constexpr double k_max_depth = 4;

/// The optical depth along the longest edge of a grid's densest voxel, in the band that it
/// attenuates most.
double voxel_depth(const VolumeReport& report, const Medium& medium) {
    Spectrum attenuation;
    for (const ConstituentReport& of : report.constituents)
        attenuation +=
            of.max *
            medium.constituents[static_cast<std::size_t>(of.constituent)].per_unit.attenuation();
    const Vector3& edges = report.metres_per_voxel;
    return attenuation.greatest(static_cast<std::size_t>(medium.band_count())) *
           std::max({edges.x, edges.y, edges.z});
}

}  // namespace

std::optional<std::string> coarse_voxel_warning(const VolumeReport& report, const Medium& medium) {
    const double depth = voxel_depth(report, medium);
    if (!(depth > k_max_depth)) return std::nullopt;
    return fmt::format(
        "{}: grid '{}': its densest voxels are {:.2g} optical depths across: the light on the "
        "outside of such clouds may be 2 to 10 % off; give a finer grid or fewer particles, or "
        "compare with --integrator reference",
        report.file.filename().string(), report.grid, depth);
}

}  // namespace uw
