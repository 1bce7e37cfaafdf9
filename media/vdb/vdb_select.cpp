#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/base/error.h"
#include "media/vdb/vdb_header.h"

namespace uw {
namespace {

/// Levenshtein's distance: least number of letters to insert, delete or replace.
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

std::string did_you_mean(const VdbHeader& header, const std::string& name) {
    const GridSummary* best = nullptr;
    std::size_t best_distance = std::max<std::size_t>(2, name.size() / 3) + 1;
    for (const GridSummary& grid : header.grids) {
        const std::size_t distance =
            std::min(edit_distance(name, grid.name), edit_distance(name, grid.base_name));
        if (distance < best_distance) {
            best = &grid;
            best_distance = distance;
        }
    }
    return best != nullptr ? fmt::format("; did you mean '{}'?", best->name) : "";
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
            grid.tree_type.empty() ? ", of NanoVDB also fp4, fp8, fp16 and fpN" : "");
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
        refuse(fmt::format("{} grids are called '{}': say '{}'", namesakes, name, found->name));
    const std::string why = unusable_because(*found);
    if (!why.empty()) refuse(fmt::format("grid '{}' {}", found->name, why));
    return *found;
}

}  // namespace uw
