#pragma once

#include <cstdint>

#include "media/vdb/vdb_header.h"

namespace uw {

/// Traverses the tree of a grid of floats, doubles, integers or 3-vectors of them in the file
/// without decoding it, and checks that each block of values has the size implied by its masks.
/// OpenVDB 10 trusts the block sizes and would write past its buffers. `tree_offset`: where the
/// tree begins, after the transform. Throws InputError starting with `where`.
void check_layout(const VdbHeader& header, const GridSummary& grid, std::int64_t tree_offset,
                  const SourceLocation& where);

/// Checks what OpenVDB 10 believes of a frustum transform: the length of its second map's name, for
/// which it makes room, and that this is no frustum again, which it reads by recursion. Throws
/// InputError starting with `where`.
void check_transform(const VdbHeader& header, const GridSummary& grid, const SourceLocation& where);

}  // namespace uw
