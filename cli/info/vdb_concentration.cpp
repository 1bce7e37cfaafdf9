#include "cli/info/vdb_concentration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/optics/optical_depth.h"
#include "media/volumes/grid_field.h"
#include "media/volumes/load_volumes.h"
#include "media/water/water_model.h"

namespace uw {

namespace {

constexpr double k_wanted_depth = 1.5;
constexpr double k_large_per_small = 5;
constexpr std::size_t k_wanted_band = 1;  // of the default bands: 540 nm
constexpr int k_lines = 24;               // across each side

double round_to_two_digits(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)) - 1);
    return std::round(value / power) * power;
}

Affine placing(const VdbAdvice& advice) {
    return Affine::translation(advice.translate) * Affine::scale(Vector3(advice.scale));
}

VolumeDesc describe(const VdbInspection& inspection, const VdbAdvice& advice) {
    VolumeDesc desc;
    desc.file = inspection.header.file;
    desc.where = desc.file.filename().string();
    desc.world_from_upright = placing(advice);
    desc.voxel_size = advice.voxel_size;
    for (const std::string& name : advice.map) {
        GridMappingDesc mapping;
        mapping.grid = name;
        mapping.where = desc.where;
        mapping.small_ppm = 1;
        mapping.large_ppm = k_large_per_small;
        desc.grids.push_back(mapping);
    }
    return desc;
}

/// The optical depth per band across the densest voxel, which lines may miss in a sparse grid.
std::vector<double> across_voxel(const LoadedVolume& volume, const Medium& medium) {
    const AttenuationTable attenuation(medium);
    std::vector<double> depth(static_cast<std::size_t>(medium.band_count()));
    for (const VolumeReport& report : volume.reports) {
        const Vector3& h = report.metres_per_voxel;
        std::vector<double> columns(static_cast<std::size_t>(medium.constituent_count()));
        for (const ConstituentReport& part : report.constituents)
            columns[static_cast<std::size_t>(part.constituent)] +=
                part.max * std::min({h.x, h.y, h.z});
        for (int band = 0; band < medium.band_count(); ++band) {
            double& most = depth[static_cast<std::size_t>(band)];
            most = std::max(most, attenuation.optical_depth(band, 0, columns));
        }
    }
    return depth;
}

/// The largest optical depth per band of `depth` and of the lines along `axis`, which are spaced
/// evenly over the bounds.
std::vector<double> deepest(const GridField& field, const Medium& medium, const Bounds& bounds,
                            int axis, std::vector<double> depth) {
    AttenuationTable attenuation(medium);
    attenuation.uniform = {};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<double> columns(static_cast<std::size_t>(medium.constituent_count()));
    for (int i = 0; i < k_lines; ++i)
        for (int j = 0; j < k_lines; ++j) {
            Point3 a = bounds.min, b = bounds.max;
            a[u] = b[u] = bounds.min[u] + (i + 0.5) / k_lines * (bounds.max[u] - bounds.min[u]);
            a[v] = b[v] = bounds.min[v] + (j + 0.5) / k_lines * (bounds.max[v] - bounds.min[v]);
            field.column(a, b, columns);
            for (int band = 0; band < medium.band_count(); ++band) {
                const auto n = static_cast<std::size_t>(band);
                depth[n] = std::max(depth[n], attenuation.optical_depth(band, 0, columns));
            }
        }
    return depth;
}

}  // namespace

void start_concentrations(const VdbInspection& inspection, VdbAdvice& advice) {
    const VolumeDesc desc = describe(inspection, advice);
    const WaterDesc water;
    const WaterModel model = build_water_model(water, {desc});
    LoadedVolume volume = load_volume(desc, model.loads[0]);
    const std::vector<double> least = across_voxel(volume, model.medium);
    const GridField field(std::move(volume.grids), model.medium.constituent_count());
    advice.bounds = Bounds();
    for (const GridVolume& grid : field.volumes()) advice.bounds.extend(grid.voxel_bounds());
    std::array<std::vector<double>, 3> depths;
    for (int axis = 0; axis < 3; ++axis)
        depths[static_cast<std::size_t>(axis)] =
            deepest(field, model.medium, advice.bounds, axis, least);
    std::ranges::sort(depths, {}, [](const std::vector<double>& d) { return d[k_wanted_band]; });

    advice.small_ppm = round_to_two_digits(k_wanted_depth / depths[1][k_wanted_band]);
    advice.large_ppm = k_large_per_small * advice.small_ppm;
    advice.bands_nm = water.bands_nm;
    advice.optical_depth.clear();
    for (const double depth : depths[1]) advice.optical_depth.push_back(depth * advice.small_ppm);
}

void choose_concentrations(const VdbInspection& inspection, const Bounds& others,
                           VdbAdvice& advice) {
    start_concentrations(inspection, advice);
    const Affine world_from_upright = placing(advice);
    if (!others.empty())
        for (const Point3& corner : {others.min, others.max})
            advice.bounds.extend(world_from_upright * corner);
    VolumeDesc desc = describe(inspection, advice);
    for (GridMappingDesc& mapping : desc.grids) {
        mapping.small_ppm = advice.small_ppm;
        mapping.large_ppm = advice.large_ppm;
    }
    advice.view = view_plume(desc, advice.bounds);
    const double small_ppm = round_to_two_digits(advice.view.factor * advice.small_ppm);
    for (double& depth : advice.optical_depth) depth *= small_ppm / advice.small_ppm;
    advice.small_ppm = small_ppm;
    advice.large_ppm = k_large_per_small * small_ppm;
    const double contrast = advice.view.draft.contrast;
    advice.lines.push_back(fmt::format(
        "small: {:g} and large: {:g} ppm per unit give an optical depth of about {:.2g} at {:g} nm "
        "through the densest part, and a contrast of {:.0f} % in a draft of the scene that --scene "
        "prints (in {}): {}. Your own plume's concentration may differ.",
        advice.small_ppm, advice.large_ppm, advice.optical_depth[k_wanted_band],
        advice.bands_nm[k_wanted_band], 100 * contrast, advice.view.proposal.water,
        contrast >= k_plain_to_see ? "neither invisible nor black"
                                   : "it will hardly be seen; a smaller transform.scale brings "
                                     "camera and lamps nearer"));
}

}  // namespace uw
