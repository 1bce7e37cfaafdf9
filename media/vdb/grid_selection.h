#pragma once

#include <string>

#include "media/vdb/vdb_header.h"

namespace uw {

/// Why the grid's values cannot be concentrations, to follow "grid 'x' "; "" if its header gives no
/// such reason.
std::string unusable_because(const GridSummary& grid);

/// The grid that a scene calls `name`, if it can be used as concentrations. Throws InputError,
/// starting with `where`, for a name that is missing or shared by several grids, and for level
/// sets, points, vectors, other types, and transforms that are not affine; the message lists the
/// file's grids.
const GridSummary& select_grid(const VdbHeader& header, const std::string& name,
                               const SourceLocation& where);

}  // namespace uw
