#include "cli/info/grid_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace uw {

namespace {

bool contains_any(const std::string& text, std::initializer_list<const char*> parts) {
    return std::ranges::any_of(
        parts, [&](const char* part) { return text.find(part) != std::string::npos; });
}

/// Distances to a surface, in grids whose class does not say so.
bool is_level_set_in_disguise(const GridInspection& grid) {
    return grid.values && grid.summary.grid_class != "fog volume" &&
           grid.values->background_value > 0 && grid.values->negative > 0;
}

std::string list(const std::vector<std::string>& names) {
    return fmt::format("'{}'", fmt::join(names, "', '"));
}

void say_what_to_map(const VdbInspection& inspection, VdbAdvice& advice) {
    const GridInspection* const chosen = likeliest_grid(inspection);
    if (chosen == nullptr) {
        advice.lines.push_back("Nothing to map: no grid of this file is a concentration.");
        return;
    }
    for (const GridInspection& grid : inspection.grids)
        if (grid.summary.base_name == chosen->summary.base_name && can_be_mapped(grid)) {
            advice.map.push_back(grid.summary.name);
            advice.bounds.extend(grid.world_bounds);
        }
    const int best = concentration_likelihood(chosen->summary.base_name);
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

}  // namespace

std::string lower_case(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool can_be_mapped(const GridInspection& grid) {
    return grid.unusable.empty() && grid.unread.empty() && grid.values && grid.values->max > 0 &&
           !is_level_set_in_disguise(grid);
}

int concentration_likelihood(const std::string& name) {
    const std::string text = lower_case(name);
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

const GridInspection* likeliest_grid(const VdbInspection& inspection) {
    int best = 0;
    const GridInspection* chosen = nullptr;
    for (const GridInspection& grid : inspection.grids) {
        if (!can_be_mapped(grid)) continue;
        const int likelihood = concentration_likelihood(grid.summary.base_name);
        if (likelihood <= best) continue;
        best = likelihood;
        chosen = &grid;
    }
    return chosen;
}

void choose_grids(const VdbInspection& inspection, VdbAdvice& advice) {
    say_what_to_map(inspection, advice);
    say_what_to_leave(inspection, advice);
}

void say_what_is_wrong(const VdbInspection& inspection, VdbAdvice& advice) {
    for (const GridInspection& grid : inspection.grids) say_what_is_wrong(grid, advice);
}

}  // namespace uw
