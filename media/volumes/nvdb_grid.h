#pragma once

#include <openvdb/openvdb.h>

#include "media/volumes/vdb_header.h"

namespace uw {

/// A validated and decompressed grid of a NanoVDB file: its active values, as a grid of type
/// `grid.value_type` (one of ReadableGrids). Throws InputError starting with `where` if it is
/// damaged.
openvdb::GridBase::Ptr read_nvdb_grid(const VdbHeader& header, const GridSummary& grid,
                                      const SourceLocation& where);

/// The transform of a grid of a NanoVDB file. Throws as read_nvdb_grid.
openvdb::math::Transform::Ptr read_nvdb_transform(const VdbHeader& header, const GridSummary& grid,
                                                  const SourceLocation& where);

}  // namespace uw
