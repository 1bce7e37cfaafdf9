#include "media/vdb/vdb_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace uw {

bool VdbHeader::from_blender_fluid() const {
    if (!creator.empty() || grids.empty()) return false;
    const auto has_mark = [](const GridSummary& grid) { return grid.base_resolution.has_value(); };
    if (std::any_of(grids.begin(), grids.end(), has_mark)) return true;
    constexpr std::string_view k_noise = "_noise";
    static constexpr std::array<std::string_view, 13> names{
        "velocity", "density", "shadow", "temperature", "heat",  "flame",   "color_r",
        "color_g",  "color_b", "fuel",   "react",       "flags", "pressure"};
    bool telling = false;  // a name that no other program uses besides "density"
    for (const GridSummary& grid : grids) {
        std::string_view name = grid.base_name;
        const bool noise = name.ends_with(k_noise);
        if (noise) name.remove_suffix(k_noise.size());
        telling |= noise || name == "shadow";
        const bool known = std::find(names.begin(), names.end(), name) != names.end();
        if (!known && !name.starts_with("phi_")) return false;
    }
    return telling;
}

bool VdbHeader::from_embergen() const {
    if (creator.find("EmberGen") != std::string::npos) return true;
    return std::ranges::any_of(grids, [this](const GridSummary& grid) {
        return grid.from_embergen || (creator.empty() && grid.base_name == "flames");
    });
}

bool VdbHeader::from_houdini() const {
    return creator.find("Houdini") != std::string::npos ||
           creator.find("GEO_VDB") != std::string::npos;
}

std::string VdbHeader::describe_grids() const {
    if (grids.empty()) return "no grids";
    std::string list;
    constexpr std::size_t most = 24;
    for (std::size_t i = 0; i < std::min(grids.size(), most); ++i)
        list += fmt::format("{}{} ({}{}, {})", i == 0 ? "" : ", ", grids[i].name,
                            grids[i].half ? "half " : "", grids[i].value_type, grids[i].grid_class);
    if (grids.size() > most) list += fmt::format(" and {} more", grids.size() - most);
    return list;
}

}  // namespace uw
