#pragma once

#include <cstdint>
#include <filesystem>

#include "media/vdb/byte_reader.h"
#include "media/vdb/vdb_header.h"

namespace uw {

/// Whether a file that begins with these 8 bytes is NanoVDB's.
bool is_nvdb_magic(std::int64_t magic);

/// The header of a NanoVDB file whose first 8 bytes have been read, all its segments and the
/// metadata of its grids. Throws InputError as read_vdb_header does.
VdbHeader read_nvdb_header(ByteReader& in, const std::filesystem::path& file);

}  // namespace uw
