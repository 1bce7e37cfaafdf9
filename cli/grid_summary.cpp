#include "cli/grid_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/light/medium.h"

namespace uw {

namespace {

std::string describe_bounds(const Bounds& b) {
    return fmt::format("x {:.4g}..{:.4g}, y {:.4g}..{:.4g}, z {:.4g}..{:.4g} m", b.min.x, b.max.x,
                       b.min.y, b.max.y, b.min.z, b.max.z);
}

std::string describe_depth(const VolumeReport& report, const Medium& medium, std::size_t axis) {
    const std::vector<double> depth = depth_through_middle(report, medium, axis);
    std::string text;
    for (std::size_t b = 0; b < depth.size(); ++b)
        text += fmt::format("{}{:.3g} ({:g} nm)", b == 0 ? "" : ", ", depth[b],
                            medium.wavelengths_nm[b]);
    return text;
}

}  // namespace

std::vector<double> depth_through_middle(const VolumeReport& report, const Medium& medium,
                                         std::size_t axis) {
    const AttenuationTable attenuation(medium);
    std::vector<double> depth(static_cast<std::size_t>(medium.band_count()));
    for (std::size_t band = 0; band < depth.size(); ++band)
        for (const ConstituentReport& c : report.constituents)
            depth[band] += c.column[axis] *
                           attenuation.constituents[static_cast<std::size_t>(c.constituent)][band];
    return depth;
}

std::string describe_grid(const VolumeReport& report, const Medium& medium) {
    const Vector3& h = report.metres_per_voxel;
    const Placement& p = report.placement;
    std::string text = fmt::format(
        "{}: grid '{}': {:.4g} x {:.4g} x {:.4g} m per voxel, {} active voxels, {:.1f} MB\n",
        report.file.filename().string(), report.grid, h.x, h.y, h.z,
        report.statistics.active_voxels, static_cast<double>(report.bytes) / 1e6);
    text +=
        fmt::format("  centering {}{}, up {}{}\n", p.centering == Centering::cell ? "cell" : "node",
                    p.automatic_centering ? " (automatic)" : "", p.up == UpAxis::z ? "z" : "y",
                    p.automatic_up ? " (automatic)" : "");
    if (report.bounds.empty()) return text + "  no values above 0\n";
    text += "  bounds " + describe_bounds(report.bounds) + "\n";
    for (const ConstituentReport& c : report.constituents) {
        const Constituent& constituent =
            medium.constituents[static_cast<std::size_t>(c.constituent)];
        text +=
            fmt::format("  {}: min {:.4g}, mean {:.4g}, max {:.4g}{}\n", constituent.name, c.min,
                        c.mean, c.max, constituent.unit == "1" ? "" : " " + constituent.unit);
    }
    const char* const axes = "xyz";
    for (std::size_t axis = 0; axis < 3; ++axis)
        text += fmt::format("  optical depth through the middle along {}: {}\n", axes[axis],
                            describe_depth(report, medium, axis));
    return text;
}

}  // namespace uw
