#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/output_files.h"

namespace uw {

/// The CRC-32 of PNG, zlib and MCAP (ISO 3309); `before`: that of the bytes before these.
std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before = 0);

/// Writes an MCAP file of messages (mcap.dev/spec, version 0), in chunks that are not compressed,
/// with all indices and checksums. Schemas and channels are added first, then messages.
class McapWriter {
  public:
    /// Throws as AtomicFile's constructor. `profile`: "ros2".
    McapWriter(const std::filesystem::path& file, std::string_view profile,
               std::string_view library);

    /// Adds a schema, and returns its id.
    std::uint16_t add_schema(std::string_view name, std::string_view encoding,
                             std::string_view text);
    /// Adds a channel, and returns its id.
    std::uint16_t add_channel(std::uint16_t schema, std::string_view topic,
                              std::string_view message_encoding,
                              const std::map<std::string, std::string>& metadata);
    /// Adds a message at a time [ns].
    void add_message(std::uint16_t channel, std::uint64_t time, std::string_view data);

    /// Writes the rest; the file then has its name. Throws IoError.
    void commit();

  private:
    struct Chunk {
        std::string records;
        std::uint64_t first = 0, last = 0;  // times
        /// Times and places in `records` of each channel's messages.
        std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> places;
    };

    void write(std::string_view bytes);
    void end_chunk();
    void write_summary();

    OutputFile file_;
    std::uint32_t crc_ = 0;                    // of all that has been written
    std::string schemas_, channels_, chunks_;  // their records in the summary
    std::uint16_t schema_count_ = 0, channel_count_ = 0;
    std::uint32_t chunk_count_ = 0;
    std::map<std::uint16_t, std::uint64_t> messages_;  // how many a channel has
    std::uint64_t first_ = 0, last_ = 0;               // times of all messages
    Chunk chunk_;
};

}  // namespace uw
