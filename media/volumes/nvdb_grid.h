#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <memory>

#include "media/volumes/vdb_header.h"

namespace uw {

/// A decompressed grid of a NanoVDB file, suitably aligned for its nodes.
struct NvdbBytes {
    std::shared_ptr<const std::uint8_t> data;
    std::uint64_t size = 0;
};

/// Reads and decompresses the bytes of `grid`. Of their contents, only the grid header's magic
/// number and its claimed size are checked. Throws InputError starting with `where`; std::bad_alloc
/// if memory does not suffice.
NvdbBytes read_nvdb_bytes(const VdbHeader& header, const GridSummary& grid,
                          const SourceLocation& where);

/// A validated and decompressed grid of a NanoVDB file: its active values, as a grid of type
/// `grid.value_type` (one of ReadableGrids). Throws InputError starting with `where` if it is
/// damaged.
openvdb::GridBase::Ptr read_nvdb_grid(const VdbHeader& header, const GridSummary& grid,
                                      const SourceLocation& where);

/// The transform of a grid of a NanoVDB file. Throws as read_nvdb_grid.
openvdb::math::Transform::Ptr read_nvdb_transform(const VdbHeader& header, const GridSummary& grid,
                                                  const SourceLocation& where);

}  // namespace uw
