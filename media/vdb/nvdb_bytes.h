#pragma once

#include <cstdint>
#include <memory>

#include "media/vdb/vdb_header.h"

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

}  // namespace uw
