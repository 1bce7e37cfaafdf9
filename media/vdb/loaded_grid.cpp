#include "media/vdb/loaded_grid.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.h"

namespace uw {

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
    const double determinant = loaded.file_from_index.determinant();
    if (!std::isfinite(determinant) || determinant == 0)
        throw InputError(prefix + "its transform is singular (voxels without volume)");
}

}  // namespace uw
