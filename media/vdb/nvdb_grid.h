#pragma once

#include <openvdb/openvdb.h>

#include "media/vdb/vdb_header.h"

namespace uw {

/// A grid of a NanoVDB file, checked and unpacked: its active values, as the grid that
/// `grid.value_type` names (one of ReadableGrids). Throws InputError starting with `where` for
/// damage.
openvdb::GridBase::Ptr read_nvdb_grid(const VdbHeader& header, const GridSummary& grid,
                                      const SourceLocation& where);

/// The transform of a grid of a NanoVDB file. Throws as read_nvdb_grid.
openvdb::math::Transform::Ptr read_nvdb_transform(const VdbHeader& header, const GridSummary& grid,
                                                  const SourceLocation& where);

}  // namespace uw
