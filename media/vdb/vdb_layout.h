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

}  // namespace uw
