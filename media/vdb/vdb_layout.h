#pragma once

#include <cstdint>

#include "media/vdb/vdb_header.h"

namespace uw {

/// Walks through the tree of a grid of floats, doubles, integers or 3-vectors of them in the file
/// without decoding it, and checks
/// that each block of values has the size its masks ask for. OpenVDB 10 believes the sizes of
/// blocks and would write past its buffers. `tree_offset`: where the tree begins, after the
/// transform. Throws InputError starting with `where`.
void check_layout(const VdbHeader& header, const GridSummary& grid, std::int64_t tree_offset,
                  const SourceLocation& where);

}  // namespace uw
