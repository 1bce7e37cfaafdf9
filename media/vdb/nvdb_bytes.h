#pragma once

#include <cstdint>
#include <memory>

#include "media/vdb/vdb_header.h"

namespace uw {

/// A grid of a NanoVDB file, unpacked, at an address that its nodes may have.
struct NvdbBytes {
    std::shared_ptr<const std::uint8_t> data;
    std::uint64_t size = 0;
};

/// Reads and unpacks the bytes of `grid`. Of what they hold nothing is checked but that they begin
/// as a grid does and claim no more than they are. Throws InputError starting with `where`;
/// std::bad_alloc if they are more than the memory there is.
NvdbBytes read_nvdb_bytes(const VdbHeader& header, const GridSummary& grid,
                          const SourceLocation& where);

}  // namespace uw
