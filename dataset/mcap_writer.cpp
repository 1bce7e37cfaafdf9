#include "dataset/mcap_writer.h"

#include <algorithm>
#include <array>

#include "dataset/set_files.h"

namespace uw {

namespace {

constexpr std::string_view k_mcap_magic("\x89MCAP0\r\n", 8);
constexpr std::size_t k_chunk_bytes = std::size_t{1} << 20U;

/// The kinds of records that are written.
enum class McapRecord : std::uint8_t {
    header = 1,
    footer = 2,
    schema = 3,
    channel = 4,
    message = 5,
    chunk = 6,
    message_index = 7,
    chunk_index = 8,
    statistics = 11,
    summary_offset = 14,
    data_end = 15
};

void append_text(std::string& bytes, std::string_view text) {
    append_bytes(bytes, static_cast<std::uint32_t>(text.size()));
    bytes.append(text);
}

std::string record_bytes(McapRecord kind, std::string_view content) {
    std::string bytes;
    append_bytes(bytes, static_cast<std::uint8_t>(kind));
    append_bytes(bytes, static_cast<std::uint64_t>(content.size()));
    bytes.append(content);
    return bytes;
}

/// A map of channels to numbers.
std::string map_bytes(const std::map<std::uint16_t, std::uint64_t>& map) {
    std::string entries, bytes;
    for (const auto& [key, value] : map) {
        append_bytes(entries, key);
        append_bytes(entries, value);
    }
    append_text(bytes, entries);
    return bytes;
}

}  // namespace

std::uint32_t crc32_of(std::string_view bytes, std::uint32_t before) {
    static const std::array<std::uint32_t, 256> k_table = [] {
        std::array<std::uint32_t, 256> table{};
        for (std::uint32_t i = 0; i < table.size(); ++i) {
            table[i] = i;
            for (int bit = 0; bit < 8; ++bit)
                table[i] = (table[i] >> 1U) ^ ((table[i] & 1U) != 0 ? 0xedb88320U : 0U);
        }
        return table;
    }();
    std::uint32_t crc = ~before;
    for (const char c : bytes)
        crc = (crc >> 8U) ^ k_table[(crc ^ static_cast<unsigned char>(c)) & 0xffU];
    return ~crc;
}

McapWriter::McapWriter(const std::filesystem::path& file, std::string_view profile,
                       std::string_view library)
    : file_(file) {
    write(k_mcap_magic);
    std::string header;
    append_text(header, profile);
    append_text(header, library);
    write(record_bytes(McapRecord::header, header));
}

void McapWriter::write(std::string_view bytes) {
    file_.write(bytes);
    crc_ = crc32_of(bytes, crc_);
}

std::uint16_t McapWriter::add_schema(std::string_view name, std::string_view encoding,
                                     std::string_view text) {
    std::string schema;
    append_bytes(schema, ++schema_count_);
    append_text(schema, name);
    append_text(schema, encoding);
    append_text(schema, text);
    const std::string record = record_bytes(McapRecord::schema, schema);
    write(record);
    schemas_ += record;
    return schema_count_;
}

std::uint16_t McapWriter::add_channel(std::uint16_t schema, std::string_view topic,
                                      std::string_view message_encoding,
                                      const std::map<std::string, std::string>& metadata) {
    std::string channel, entries;
    for (const auto& [key, value] : metadata) {
        append_text(entries, key);
        append_text(entries, value);
    }
    append_bytes(channel, ++channel_count_);
    append_bytes(channel, schema);
    append_text(channel, topic);
    append_text(channel, message_encoding);
    append_text(channel, entries);
    const std::string record = record_bytes(McapRecord::channel, channel);
    write(record);
    channels_ += record;
    messages_[channel_count_] = 0;
    return channel_count_;
}

void McapWriter::add_message(std::uint16_t channel, std::uint64_t time, std::string_view data) {
    std::string message;
    message.reserve(data.size() + 22);
    append_bytes(message, channel);
    append_bytes(message, static_cast<std::uint32_t>(messages_[channel]++));
    append_bytes(message, time);  // logged
    append_bytes(message, time);  // published
    message.append(data);
    const bool is_first = chunk_.records.empty();
    chunk_.first = is_first ? time : std::min(chunk_.first, time);
    chunk_.last = is_first ? time : std::max(chunk_.last, time);
    chunk_.places[channel].emplace_back(time, chunk_.records.size());
    chunk_.records += record_bytes(McapRecord::message, message);
    if (chunk_.records.size() >= k_chunk_bytes) end_chunk();
}

void McapWriter::end_chunk() {
    if (chunk_.records.empty()) return;
    const std::uint64_t begin = file_.position();
    const std::uint64_t size = chunk_.records.size();
    std::string chunk;
    append_bytes(chunk, chunk_.first);
    append_bytes(chunk, chunk_.last);
    append_bytes(chunk, size);
    append_bytes(chunk, crc32_of(chunk_.records));
    append_text(chunk, "");  // no compression
    append_bytes(chunk, size);
    chunk += chunk_.records;
    write(record_bytes(McapRecord::chunk, chunk));
    const std::uint64_t end = file_.position();
    std::map<std::uint16_t, std::uint64_t> offsets;
    for (const auto& [channel, places] : chunk_.places) {
        offsets[channel] = file_.position();
        std::string entries, index;
        for (const auto& [time, place] : places) {
            append_bytes(entries, time);
            append_bytes(entries, place);
        }
        append_bytes(index, channel);
        append_text(index, entries);
        write(record_bytes(McapRecord::message_index, index));
    }
    std::string index;
    append_bytes(index, chunk_.first);
    append_bytes(index, chunk_.last);
    append_bytes(index, begin);
    append_bytes(index, end - begin);
    index += map_bytes(offsets);
    append_bytes(index, file_.position() - end);
    append_text(index, "");
    append_bytes(index, size);
    append_bytes(index, size);
    chunks_ += record_bytes(McapRecord::chunk_index, index);
    first_ = chunk_count_ == 0 ? chunk_.first : std::min(first_, chunk_.first);
    last_ = std::max(last_, chunk_.last);
    ++chunk_count_;
    chunk_ = {};
}

void McapWriter::write_summary() {
    const std::uint64_t begin = file_.position();
    std::uint64_t message_count = 0;
    for (const auto& [channel, count] : messages_) message_count += count;
    std::string statistics;
    append_bytes(statistics, message_count);
    append_bytes(statistics, schema_count_);
    append_bytes(statistics, static_cast<std::uint32_t>(channel_count_));
    append_bytes(statistics, std::uint32_t{0});  // attachments
    append_bytes(statistics, std::uint32_t{0});  // metadata
    append_bytes(statistics, chunk_count_);
    append_bytes(statistics, first_);
    append_bytes(statistics, last_);
    statistics += map_bytes(messages_);
    const std::array<std::pair<McapRecord, std::string>, 4> groups{
        {{McapRecord::schema, schemas_},
         {McapRecord::channel, channels_},
         {McapRecord::statistics, record_bytes(McapRecord::statistics, statistics)},
         {McapRecord::chunk_index, chunks_}}};
    std::string summary, offsets;
    for (const auto& [kind, records] : groups) {
        if (records.empty()) continue;
        std::string offset;
        append_bytes(offset, static_cast<std::uint8_t>(kind));
        append_bytes(offset, begin + summary.size());
        append_bytes(offset, static_cast<std::uint64_t>(records.size()));
        offsets += record_bytes(McapRecord::summary_offset, offset);
        summary += records;
    }
    std::string footer;
    append_bytes(footer, begin);
    append_bytes(footer, begin + summary.size());
    // The checksum is of all from the summary on, up to itself: with the footer's own first bytes.
    const std::string with_space = record_bytes(McapRecord::footer, footer + std::string(4, '\0'));
    std::string rest = summary + offsets + with_space.substr(0, with_space.size() - 4);
    append_bytes(rest, crc32_of(rest));
    file_.write(rest);
    file_.write(k_mcap_magic);
}

void McapWriter::commit() {
    end_chunk();
    std::string end;
    append_bytes(end, crc_);
    write(record_bytes(McapRecord::data_end, end));
    write_summary();
    file_.commit();
}

}  // namespace uw
