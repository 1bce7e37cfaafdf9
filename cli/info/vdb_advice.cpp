#include "cli/info/vdb_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "cli/info/vdb_concentration.h"

namespace uw {

namespace {

// Larger than lamps can light under water; too small to be the intended size [m].
constexpr double k_too_large = 30, k_too_small = 0.05;
constexpr double k_convenient = 2;  // what is brought to scale becomes this large

double longest_side(const Bounds& b) {
    return std::max({b.max.x - b.min.x, b.max.y - b.min.y, b.max.z - b.min.z});
}

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool contains_any(const std::string& text, std::initializer_list<const char*> parts) {
    return std::ranges::any_of(
        parts, [&](const char* part) { return text.find(part) != std::string::npos; });
}

/// Distances to a surface, in grids whose class does not say so.
bool is_level_set_in_disguise(const GridInspection& grid) {
    return grid.values && grid.summary.grid_class != "fog volume" &&
           grid.values->background_value > 0 && grid.values->negative > 0;
}

bool can_be_mapped(const GridInspection& grid) {
    return grid.unusable.empty() && grid.unread.empty() && grid.values && grid.values->max > 0 &&
           !is_level_set_in_disguise(grid);
}

std::string list(const std::vector<std::string>& names) {
    return fmt::format("'{}'", fmt::join(names, "', '"));
}

void say_what_to_map(const VdbInspection& inspection, VdbAdvice& advice) {
    int best = 0;
    const GridInspection* chosen = nullptr;
    for (const GridInspection& grid : inspection.grids) {
        if (!can_be_mapped(grid)) continue;
        const int likelihood = concentration_likelihood(grid.summary.base_name);
        if (likelihood <= best) continue;
        best = likelihood;
        chosen = &grid;
    }
    if (chosen == nullptr) {
        advice.lines.push_back("Nothing to map: no grid of this file is a concentration.");
        return;
    }
    for (const GridInspection& grid : inspection.grids)
        if (grid.summary.base_name == chosen->summary.base_name && can_be_mapped(grid)) {
            advice.map.push_back(grid.summary.name);
            advice.bounds.extend(grid.world_bounds);
        }
    const char* const why = best == 4   ? "the name says density"
                            : best == 3 ? "by its name a concentration"
                            : best == 2 ? "the only likely one; its name says nothing"
                                        : "no density in this file, and this is the closest to it: "
                                          "check that it is what you mean";
    if (advice.map.size() == 1)
        advice.lines.push_back(fmt::format("Map {}: {}.", list(advice.map), why));
    else
        advice.lines.push_back(
            fmt::format("{} grids are called '{}': address them as {}. Map those you mean.",
                        advice.map.size(), chosen->summary.base_name, list(advice.map)));
}

/// Grids with valid values that hold something other than a concentration.
void say_what_to_leave(const VdbInspection& inspection, VdbAdvice& advice) {
    std::vector<std::string> others;
    for (const GridInspection& grid : inspection.grids) {
        const bool mapped = std::ranges::count(advice.map, grid.summary.name) > 0;
        if (mapped || !can_be_mapped(grid)) continue;
        if (concentration_likelihood(grid.summary.base_name) < 2)
            others.push_back(grid.summary.name);
    }
    if (!others.empty())
        advice.lines.push_back(fmt::format("Not a concentration by name: {}.", list(others)));
}

void say_what_is_wrong(const GridInspection& grid, VdbAdvice& advice) {
    const std::string name = fmt::format("Grid '{}' ", grid.summary.name);
    const auto say = [&](const std::string& text) { advice.lines.push_back(name + text + "."); };
    if (!grid.unusable.empty()) say(grid.unusable);
    if (grid.unusable.empty() && is_level_set_in_disguise(grid))
        say("is a level set, though its class does not say so (its background is above 0, its "
            "inside negative), not a concentration; export a fog volume");
    if (grid.unusable.empty() && !grid.unread.empty()) say("cannot be read: " + grid.unread);
    if (grid.active_voxels == 0) say("is empty: it has no active voxels");
    if (!grid.values || grid.values->active == 0 || !grid.unusable.empty()) return;
    const ValueSummary& v = *grid.values;
    if (v.nan > 0)
        say(fmt::format("has {} NaN among its {} values: they count as 0", v.nan, v.active));
    if (v.infinite > 0) say(fmt::format("has {} infinite values: they count as 0", v.infinite));
    if (v.negative > 0 && v.negative < v.finite && !is_level_set_in_disguise(grid))
        say(fmt::format("has {} negative values: they count as 0", v.negative));
    if (v.finite > 0 && v.max <= 0)
        say(fmt::format("has no value above 0 (from {:g} to {:g}): it would be invisible", v.min,
                        v.max));
    if (v.background_value != 0 && !is_level_set_in_disguise(grid))
        say("has a background of " + v.background + ": it counts as 0 outside the active voxels");
}

void say_placement(const VdbInspection& inspection, VdbAdvice& advice) {
    const VdbHeader& header = inspection.header;
    if (header.from_blender_fluid()) {
        advice.lines.push_back(
            "Up is z, values sit in the middle of cells: a cache of Blender's fluid solver, "
            "recognised by its grids. Index (0, 0, 0) is the domain's corner; the file does not "
            "record where that is: translate it there, (x, y, z) in Blender is [x, z, -y] here.");
        return;
    }
    const bool houdini = header.creator.find("Houdini") != std::string::npos ||
                         header.creator.find("GEO_VDB") != std::string::npos;
    advice.lines.push_back(fmt::format(
        "Up is y, values sit at nodes (index i at i times the voxel): {}.{}",
        houdini ? fmt::format("written by Houdini, as its creator '{}' says", header.creator)
                : "nothing in the file says otherwise",
        houdini ? ""
                : " If it lies on its side, write up: z; if half a voxel off, centering: cell."));
}

void say_motion(const VdbInspection& inspection, VdbAdvice& advice) {
    const auto has = [&](const std::string& name) {
        return std::ranges::any_of(inspection.grids, [&](const GridInspection& grid) {
            return grid.summary.name == name && grid.unread.empty() && grid.active_voxels != 0;
        });
    };
    std::string grid;
    for (const GridInspection& candidate : inspection.grids)
        if (candidate.summary.value_type == "vec3s" && has(candidate.summary.name) &&
            lower(candidate.summary.base_name).starts_with("vel"))
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

std::string size_of(const VdbAdvice& advice) {
    return fmt::format("{:.3g} m", longest_side(advice.bounds));
}

/// Decides `scale`.
void say_units(const VdbInspection& inspection, VdbAdvice& advice) {
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

std::string quoted(const std::string& text) {
    const bool plain = !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_';
    }) && std::isalpha(static_cast<unsigned char>(text[0])) != 0;
    if (plain && lower(text) != "null" && lower(text) != "true" && lower(text) != "false")
        return text;
    std::string result = "'";
    for (const char c : text) result += c == '\'' ? "''" : std::string(1, c);
    return result + "'";
}

void write_block(const VdbInspection& inspection, const std::filesystem::path& file,
                 VdbAdvice& advice) {
    std::string& yaml = advice.volumes;
    yaml = "volumes:\n";
    yaml += fmt::format("  - file: {}\n    grids:\n", quoted(file.string()));
    for (const std::string& name : advice.map)
        yaml += fmt::format("      {}: {{small: {:g}, large: {:g}}}    # ppm per unit\n",
                            quoted(name), advice.small_ppm, advice.large_ppm);
    const Placement& p = inspection.placement;
    yaml += fmt::format("    centering: {}\n    up: {}\n",
                        p.centering == Centering::cell ? "cell" : "node",
                        p.up == UpAxis::z ? "z" : "y");
    yaml += fmt::format("    transform: {{scale: {:g}, translate: [0, 0, 0]}}\n", advice.scale);
}

void place_eye(VdbAdvice& advice) {
    advice.target = advice.bounds.center();
    // From the front, a little above: a field of view of 50 degrees holds the sphere around it.
    const double away = 0.5 * advice.bounds.diagonal() / std::sin(0.43);
    advice.eye = advice.target + away * glm::normalize(Vector3(0, 0.15, 1));
}

}  // namespace

int concentration_likelihood(const std::string& name) {
    const std::string text = lower(name);
    if (contains_any(text, {"shadow", "vel", "phi_", "pressure", "divergence", "curl", "color",
                            "flags", "sdf", "surface", "distance", "normal", "particle_id",
                            "gradient", "collision", "mask"}) ||
        text == "cd" || text == "v" || text == "id" || text == "rest")
        return 0;
    if (contains_any(text, {"temp", "heat", "flame", "fire", "fuel", "react", "burn", "emission"}))
        return 1;
    if (text.find("density") != std::string::npos) return 4;
    if (contains_any(text, {"smoke", "fog", "cloud", "dust", "plume", "concentration", "sediment",
                            "soot", "dye", "tracer", "ppm", "silt"}))
        return 3;
    return 2;
}

VdbAdvice advise_on_vdb(const VdbInspection& inspection, const std::filesystem::path& file) {
    VdbAdvice advice;
    say_what_to_map(inspection, advice);
    say_what_to_leave(inspection, advice);
    for (const GridInspection& grid : inspection.grids) say_what_is_wrong(grid, advice);
    if (advice.map.empty()) return advice;
    say_placement(inspection, advice);
    say_units(inspection, advice);
    say_motion(inspection, advice);
    choose_concentrations(inspection, advice);
    place_eye(advice);
    write_block(inspection, file, advice);
    return advice;
}

}  // namespace uw
