#include "media/vdb/loaded_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace uw {

namespace {

// Whether a voxel has no volume to speak of beside its edges: sums along rays through it are not to
// be trusted.
bool is_flat(const Matrix3& edges) {
    constexpr double k_flattest = 1e-6;
    const double longest =
        std::max({glm::length(edges[0]), glm::length(edges[1]), glm::length(edges[2])});
    const double volume = std::abs(glm::determinant(edges / longest));
    return !(std::isfinite(longest) && volume > k_flattest);
}

}  // namespace

void check_loaded(const VdbHeader& header, const GridSummary& grid, const std::string& prefix,
                  const LoadedGrid& loaded) {
    const bool classless = grid.grid_class != "fog volume";
    const std::int64_t negative = loaded.statistics.negative_voxels;
    if (classless && loaded.statistics.background > 0 && negative > 0)
        throw InputError(fmt::format(
            "{}is a level set, though its class is '{}' (background {:g}, {} negative voxels), not "
            "a concentration; export a fog volume; the file has {}",
            prefix, grid.grid_class, loaded.statistics.background, negative,
            header.describe_grids()));
    if (is_flat(loaded.file_from_index.linear()))
        throw InputError(prefix + "its transform is singular (voxels without volume)");
}

}  // namespace uw
