#pragma once

#include <string>
#include <vector>

#include "core/base/affine.h"
#include "media/vdb/grid_statistics.h"
#include "media/vdb/nano_grid.h"
#include "media/vdb/vdb_header.h"

namespace uw {

/// A grid ready to be sampled. Large grids are split into several bricks whose values add up: each
/// holds a slab of whole 8^3 blocks, and interpolation with zeros outside is linear.
struct LoadedGrid {
    std::string name;
    Affine file_from_index;  // the file's transform: metres, index (i, j, k) where OpenVDB puts it
    std::vector<NanoGrid> bricks;  // none if every value is zero
    GridStatistics statistics;
    std::vector<std::string> warnings;  // one line each, starting with `where`
};

/// Throws InputError starting with `prefix` if the loaded grid is an undeclared level set, or if
/// its voxels have no volume.
void check_loaded(const VdbHeader& header, const GridSummary& grid, const std::string& prefix,
                  const LoadedGrid& loaded);

}  // namespace uw
