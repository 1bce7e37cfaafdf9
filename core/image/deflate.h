#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace uw {

/// `bytes` as a zlib stream (RFC 1950), compressed with little effort: in images, more of it saves
/// some per cent at several times the cost.
std::vector<std::byte> zlib_stream(std::span<const std::byte> bytes);

/// A zlib stream compressed on all permitted threads, in parts of `part_bytes`, which determine
/// its bytes; the number of threads does not. Finds repetitions of the byte before only, which is
/// what filtered images consist of.
std::vector<std::byte> zlib_stream_in_parts(std::span<const std::byte> bytes,
                                            std::size_t part_bytes);

/// The check sum of PNG's chunks, continued from that of the bytes before; 0 to begin with.
std::uint32_t crc32_of(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace uw
