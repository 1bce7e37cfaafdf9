#include "cli/grid_summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/optical_depth.h"

namespace uw {

namespace {

std::string describe_bounds(const Bounds& b) {
    return fmt::format("x {:.4g}..{:.4g}, y {:.4g}..{:.4g}, z {:.4g}..{:.4g} m", b.min.x, b.max.x,
                       b.min.y, b.max.y, b.min.z, b.max.z);
}

// Optical depth of the grid's own particles along world axis `axis` through its middle.
std::string describe_depth(const VolumeReport& report, const Medium& medium, std::size_t axis) {
    const AttenuationTable attenuation(medium);
    std::string text;
    for (int band = 0; band < medium.band_count(); ++band) {
        const auto b = static_cast<std::size_t>(band);
        double tau = 0;
        for (const ConstituentReport& c : report.constituents)
            tau += c.column[axis] *
                   attenuation.constituents[static_cast<std::size_t>(c.constituent)][b];
        text +=
            fmt::format("{}{:.3g} ({:g} nm)", band == 0 ? "" : ", ", tau, medium.wavelengths_nm[b]);
    }
    return text;
}

}  // namespace

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
