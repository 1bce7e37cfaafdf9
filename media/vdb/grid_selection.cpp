#include "media/vdb/grid_selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {
namespace {

std::string did_you_mean(const VdbHeader& header, const std::string& name) {
    std::vector<std::string_view> names;
    for (const GridSummary& grid : header.grids) {
        names.emplace_back(grid.name);
        names.emplace_back(grid.base_name);
    }
    const std::string_view near = nearest_word(name, names);
    if (near.empty()) return "";
    // The first of the grids that share a base name.
    const auto grid = std::ranges::find_if(header.grids, [&](const GridSummary& candidate) {
        return candidate.name == near || candidate.base_name == near;
    });
    return fmt::format("; did you mean '{}'?", grid->name);
}

}  // namespace

std::string unusable_because(const GridSummary& grid) {
    if (grid.value_type.starts_with("ptdataidx") || grid.value_type.starts_with("ptidx"))
        return "holds points, not a concentration; rasterise them to a fog volume first";
    if (grid.value_type.starts_with("vec"))
        return fmt::format("holds vectors ({}); name a grid with one number per voxel",
                           grid.value_type);
    if (grid.tree_type != "Tree_float_5_4_3" && grid.tree_type != "Tree_double_5_4_3")
        return fmt::format(
            "has values of type {}; concentrations are float or double{}", grid.value_type,
            grid.tree_type.empty() ? ", or in NanoVDB also fp4, fp8, fp16 and fpN" : "");
    if (grid.grid_class == "level set")
        return "is a level set (distances to a surface), not a concentration; export a fog volume";
    if (grid.map_type == "NonlinearFrustumMap")
        return "has a frustum (camera-shaped) transform; resample it to an affine one";
    return "";
}

const GridSummary& select_grid(const VdbHeader& header, const std::string& name,
                               const SourceLocation& where) {
    const auto refuse = [&](const std::string& why) {
        throw InputError(fmt::format("{}: {} ('{}' has {})", where, why, header.file.string(),
                                     header.describe_grids()));
    };
    const GridSummary* found = nullptr;
    int namesakes = 0;
    for (const GridSummary& grid : header.grids)
        if (grid.name == name || grid.base_name == name) {
            if (namesakes++ == 0) found = &grid;
        }
    if (namesakes == 0) refuse(fmt::format("no grid '{}'{}", name, did_you_mean(header, name)));
    if (namesakes > 1)
        refuse(fmt::format("{} grids are called '{}'; write '{}' for the first", namesakes, name,
                           found->name));
    const std::string why = unusable_because(*found);
    if (!why.empty()) refuse(fmt::format("grid '{}' {}", found->name, why));
    return *found;
}

}  // namespace uw
