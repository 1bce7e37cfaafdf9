#pragma once

#include <cstdint>
#include <filesystem>

#include "media/vdb/vdb_header.h"

namespace uw {

inline constexpr std::uint32_t k_oldest_vdb_version = 220;
inline constexpr std::uint32_t k_newest_vdb_version = 224;

/// Reads the header and the metadata of all grids of a VDB or NanoVDB file, distinguished by their
/// magic numbers; sizes that the file claims are first checked against its length. Throws IoError
/// if the file cannot be opened; InputError, starting with `where`, if it is neither, is truncated,
/// or has a version other than 220 to 224 (NanoVDB: 32).
VdbHeader read_vdb_header(const std::filesystem::path& file, const SourceLocation& where);

}  // namespace uw
