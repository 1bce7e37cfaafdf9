#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/affine.h"
#include "media/vdb/grid_statistics.h"
#include "media/vdb/nano_grid.h"
#include "media/vdb/vdb_header.h"

namespace uw {

/// A grid ready to be sampled. Large grids come in several bricks whose values add: each holds a
/// slab of whole 8^3 blocks, and interpolation with zeros outside is linear.
struct LoadedGrid {
    std::string name;
    Affine file_from_index;  // the file's transform: metres, index (i, j, k) where OpenVDB puts it
    std::vector<NanoGrid> bricks;  // none if every value is zero
    GridStatistics statistics;
    std::vector<std::string> warnings;  // one line each, starting with `where`
};

inline constexpr std::size_t k_default_slab_bytes = std::size_t{256} << 20;

/// Reads one grid of `header.file`. Voxels pass through memory in slabs of at most about
/// `slab_bytes` of 32-bit values (but no fewer than an eighth of the grid); what stays is 16-bit.
/// Throws InputError starting with `where` if it cannot be used (see select_grid), is a level set
/// in disguise, or cannot be decoded.
LoadedGrid load_grid(const VdbHeader& header, const std::string& name, const SourceLocation& where,
                     std::size_t slab_bytes = k_default_slab_bytes);

/// The transform alone of a grid (LoadedGrid::file_from_index). Throws as load_grid.
Affine read_file_from_index(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where);

}  // namespace uw
