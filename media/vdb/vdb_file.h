#pragma once

#include <cstddef>
#include <string>

#include "media/vdb/loaded_grid.h"

namespace uw {

inline constexpr std::size_t k_default_slab_bytes = std::size_t{256} << 20;

/// Reads one grid of `header.file`. Voxels are processed in slabs of at most about `slab_bytes` of
/// 32-bit values (but no less than an eighth of the grid); the result is 16-bit. Throws InputError
/// starting with `where` if it cannot be used (see select_grid), is an undeclared level set, or
/// cannot be decoded.
LoadedGrid load_grid(const VdbHeader& header, const std::string& name, const SourceLocation& where,
                     std::size_t slab_bytes = k_default_slab_bytes);

/// Only the transform of a grid (LoadedGrid::file_from_index). Throws as load_grid.
Affine read_file_from_index(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where);

}  // namespace uw
