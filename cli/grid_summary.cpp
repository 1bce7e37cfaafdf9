#include "cli/grid_summary.h"

#include <fmt/format.h>

#include <array>

namespace uw {

std::string bounds_text(const Bounds& b) {
    return fmt::format("x {:.4g}..{:.4g}, y {:.4g}..{:.4g}, z {:.4g}..{:.4g} m", b.min.x, b.max.x,
                       b.min.y, b.max.y, b.min.z, b.max.z);
}

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

Report report_on_grid(const VolumeReport& volume, const Medium& medium) {
    const Vector3& h = volume.metres_per_voxel;
    Report report(fmt::format(
        "{}: grid '{}': {:.4g} x {:.4g} x {:.4g} m per voxel, {} active voxels, {:.1f} MB",
        volume.file.filename().string(), volume.grid, h.x, h.y, h.z,
        volume.statistics.active_voxels, static_cast<double>(volume.bytes) / 1e6));
    const Placement& p = volume.placement;
    const char* const up = name_of_up(p.up);
    const char* const centering = p.centering == Centering::cell ? "cell" : "node";
    report.say(fmt::format("centering {}{}, up {}{}", centering,
                           p.automatic_centering ? " (automatic)" : "", up,
                           p.automatic_up ? " (automatic)" : ""));
    report.set({{"file", volume.file.string()},
                {"grid", volume.grid},
                {"metres_per_voxel", vector_json(h)},
                {"world_bounds", bounds_json(volume.bounds)},
                {"active_voxels", volume.statistics.active_voxels},
                {"up", up},
                {"centering", centering}});
    const bool is_empty = volume.bounds.empty();
    report.say(is_empty ? "no values above 0" : "bounds " + bounds_text(volume.bounds));
    std::vector<Report> constituents;
    const std::size_t middle = medium.wavelengths_nm.size() / 2;
    for (const ConstituentReport& c : volume.constituents) {
        const Constituent& constituent =
            medium.constituents[static_cast<std::size_t>(c.constituent)];
        const std::string unit = constituent.unit == "1" ? "" : " " + constituent.unit;
        std::array<double, 3> depth{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            depth[axis] = c.column[axis] * constituent.per_unit.attenuation(middle);
        Report& part = constituents.emplace_back();
        if (!is_empty)
            part.say(fmt::format(
                "{}: min {:.4g}, mean {:.4g}, max {:.4g}{}; optical depth along x, y, z at {:g} nm "
                "{:.3g}, {:.3g}, {:.3g}",
                constituent.name, c.min, c.mean, c.max, unit, medium.wavelengths_nm[middle],
                depth[0], depth[1], depth[2]));
        part.set({{"name", constituent.name},
                  {"unit", constituent.unit},
                  {"optical_depth", list_json({depth.begin(), depth.end()})},
                  {"min", number_json(c.min)},
                  {"mean", number_json(c.mean)},
                  {"max", number_json(c.max)}});
    }
    report.add("constituents", constituents);
    Report depths;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string name(1, "xyz"[axis]);
        const std::vector<double> depth = depth_through_middle(volume, medium, axis);
        depths.set({{name, list_json(depth)}});
        std::string text;
        for (std::size_t b = 0; b < depth.size(); ++b)
            text += fmt::format("{}{:.3g} ({:g} nm)", b == 0 ? "" : ", ", depth[b],
                                medium.wavelengths_nm[b]);
        if (!is_empty)
            depths.say(fmt::format("optical depth through the middle along {}: {}", name, text));
    }
    report.add("optical_depth", depths);
    return report;
}

std::string describe_grid(const VolumeReport& volume, const Medium& medium) {
    return report_on_grid(volume, medium).text();
}

}  // namespace uw
