#pragma once

#include <string>

#include "media/vdb/vdb_header.h"

namespace uw {

/// Why the grid's values are no concentrations, to follow "grid 'x' "; "" if nothing in its header
/// speaks against them.
std::string unusable_because(const GridSummary& grid);

/// The grid a scene calls `name`, if its concentrations can be used. Throws InputError, starting
/// with `where`, for a name that is missing or shared by several grids, and for level sets, points,
/// vectors, other types, and transforms that are not affine; the message lists what the file has.
const GridSummary& select_grid(const VdbHeader& header, const std::string& name,
                               const SourceLocation& where);

}  // namespace uw
