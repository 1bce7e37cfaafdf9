#include "cli/info/placement_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/info/grid_choice.h"
#include "media/volumes/adaptive_domain.h"
#include "media/volumes/fluid_config.h"

namespace uw {

namespace {

// Larger than lamps can light under water; too small to be the intended size [m].
constexpr double k_too_large = 12, k_too_small = 0.05;
constexpr double k_convenient = 2;  // what is brought to scale becomes this large

double longest_side(const Bounds& b) {
    return std::max({b.max.x - b.min.x, b.max.y - b.min.y, b.max.z - b.min.z});
}

// Farther from the origin than a scene is wide [m].
constexpr double k_far = 1000;

bool lacks(const VdbInspection& inspection, const std::string& part) {
    return std::ranges::none_of(inspection.grids, [&](const GridInspection& grid) {
        return lower_case(grid.summary.base_name).find(part) != std::string::npos;
    });
}

/// Whether the grid leaves at most a margin of its domain free on every side but above and below,
/// as frames of an adaptive domain do.
bool fills_its_domain(const GridInspection& grid) {
    constexpr int k_margin = 8;  // Blender's own is 4 voxels, and what a step moves
    const auto& domain = grid.summary.base_resolution;
    if (!domain || !grid.box) return false;
    for (const std::size_t axis : {0U, 1U})
        if (grid.box->min[axis] > k_margin || (*domain)[axis] - 1 - grid.box->max[axis] > k_margin)
            return false;
    return true;
}

void say_adaptive_domain(const VdbInspection& inspection, VdbAdvice& advice) {
    if (const auto domain = find_adaptive_domain(inspection.header)) {
        advice.lines.push_back("The voxel size is wrong: " + domain->description() + ".");
        if (domain->voxel) return;
        const double step = std::pow(10, std::floor(std::log10(domain->largest_voxel())) - 3);
        advice.voxel_size = std::floor(domain->largest_voxel() / step + 1e-6) * step;
        return;
    }
    for (const GridInspection& grid : inspection.grids)
        if (grid.summary.name == advice.map.front() && fills_its_domain(grid) &&
            !read_fluid_config(inspection.header.file))
            advice.lines.emplace_back(
                "It fills its domain. If 'Adaptive Domain' (Physics > Fluid > Settings) was on in "
                "Blender, the file's voxels are too large: give voxel_size, the domain's longest "
                "side divided by its Resolution Divisions.");
}

void say_axes(const VdbInspection& inspection, VdbAdvice& advice) {
    const VdbHeader& header = inspection.header;
    if (header.from_blender_fluid()) {
        advice.lines.emplace_back(
            "Up is z, values sit in the middle of cells: a cache of Blender's fluid solver, "
            "recognised by its grids. Index (0, 0, 0) is the domain's corner; the file does not "
            "record where that is: translate it there, (x, y, z) in Blender is [x, z, -y] here.");
        say_adaptive_domain(inspection, advice);
        return;
    }
    if (header.from_embergen()) {
        advice.lines.push_back(fmt::format(
            "Up is z, values sit at nodes (index i at i times the voxel): written by EmberGen, "
            "recognised by its metadata or its grid 'flames'.{}",
            lacks(inspection, "density")
                ? " It has no density: tick that channel in the export node, if the smoke is meant."
                : ""));
        return;
    }
    const bool houdini = header.from_houdini();
    advice.lines.push_back(fmt::format(
        "Up is y, values sit at nodes (index i at i times the voxel): {}.{}",
        houdini ? fmt::format("written by Houdini, as its creator '{}' says", header.creator)
                : "nothing in the file says otherwise",
        houdini ? ""
                : " If it lies on its side, write up: z; if half a voxel off, centering: cell."));
}

/// Decides `translate`.
void say_place(VdbAdvice& advice) {
    const Vector3 centre = advice.scale * from_origin(advice.bounds.center());
    if (!(glm::length(centre) > k_far) || !std::isfinite(glm::length(centre))) return;
    advice.translate = -glm::round(centre);
    advice.lines.push_back(fmt::format(
        "It lies {:.3g} m from the origin, as if in the coordinates of a map: the block brings it "
        "to the origin; give cameras, lamps and surfaces the same translation.",
        glm::length(centre)));
}

std::string size_of(const VdbAdvice& advice) {
    return fmt::format("{:.3g} m", longest_side(advice.bounds));
}

/// Decides `scale`.
void say_size(const VdbInspection& inspection, VdbAdvice& advice) {
    const double side = longest_side(advice.bounds);
    if (!(side > 0) || !std::isfinite(side)) return;
    bool unit_voxels = false;
    for (const GridInspection& grid : inspection.grids)
        if (grid.summary.name == advice.map.front())
            unit_voxels = grid.voxel_size == Vector3(1.0, 1.0, 1.0);
    const double power = std::pow(10, std::floor(std::log10(k_convenient / side)));
    const double fitting = power * std::floor(k_convenient / side / power);
    const auto plausible = [&](double scale) {
        return side * scale >= 0.2 && side * scale <= 0.5 * k_too_large;
    };
    if (unit_voxels) {
        advice.scale = fitting;
        advice.lines.push_back(fmt::format(
            "Units look wrong: a voxel is exactly 1 m, as if no size was set, and the whole {}. "
            "Give its true size with transform.scale; {:g} makes it {:.3g} m.",
            size_of(advice), fitting, fitting * side));
    } else if (side > k_too_large) {
        advice.scale = plausible(0.01) ? 0.01 : fitting;
        advice.lines.push_back(
            fmt::format("Units look wrong: {} is more than lamps can light under water; {} scale "
                        "{:g} makes it {:.3g} m.",
                        size_of(advice), plausible(0.01) ? "if these are centimetres," : "",
                        advice.scale, advice.scale * side));
    } else if (side < k_too_small) {
        advice.scale = plausible(100) ? 100 : fitting;
        advice.lines.push_back(fmt::format(
            "Units look wrong: {} is very small; {} scale {:g} makes it {:.3g} m.", size_of(advice),
            plausible(100) ? "if it was scaled by 1/100 on export," : "", advice.scale,
            advice.scale * side));
    } else {
        advice.lines.push_back(
            fmt::format("Units are plausible: {} along its longest side.", size_of(advice)));
    }
}

}  // namespace

void say_motion(const VdbInspection& inspection, VdbAdvice& advice) {
    const auto has = [&](const std::string& name) {
        return std::ranges::any_of(inspection.grids, [&](const GridInspection& grid) {
            return grid.summary.name == name && grid.unread.empty() && grid.active_voxels != 0;
        });
    };
    // velocity_previous, vel_before and the like are those of another moment.
    std::string grid;
    for (const GridInspection& candidate : inspection.grids)
        if (candidate.summary.value_type == "vec3s" && has(candidate.summary.name) &&
            lower_case(candidate.summary.base_name).starts_with("vel") &&
            (grid.empty() || candidate.summary.name.size() < grid.size()))
            grid = candidate.summary.name;
    if (grid.empty() && has("vel.x") && has("vel.y") && has("vel.z"))
        grid = "[vel.x, vel.y, vel.z]";
    if (grid.empty()) return;
    advice.lines.push_back(
        fmt::format("It moves: for motion blur add velocity: {{grid: {}}} to the volume, and the "
                    "exposure time in "
                    "seconds as render: {{shutter: 0.02}}.{}",
                    grid,
                    inspection.header.from_blender_fluid()
                        ? " Its unit is 2.5 voxels a second, as in Blender's solver."
                        : " Its unit is taken to be m/s."));
}

void say_placement(const VdbInspection& inspection, VdbAdvice& advice) {
    say_axes(inspection, advice);
}

void say_units(const VdbInspection& inspection, VdbAdvice& advice) {
    say_size(inspection, advice);
    say_place(advice);
}

}  // namespace uw
