#include "media/volumes/voxel_depth.h"

#include <fmt/format.h>

#include <algorithm>

namespace uw {

namespace {

constexpr double k_most_depth = 4;

}  // namespace

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

std::optional<std::string> coarse_voxel_warning(const VolumeReport& report, const Medium& medium) {
    const double depth = voxel_depth(report, medium);
    if (!(depth > k_most_depth)) return std::nullopt;
    return fmt::format(
        "{}: grid '{}': its densest voxels are {:.2g} optical depths across: the light on the "
        "outside of such clouds may be 2 to 10 % off; give a finer grid or fewer particles, or "
        "compare with --integrator reference",
        report.file.filename().string(), report.grid, depth);
}

}  // namespace uw
