#include "media/vdb/byte_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/base/error.h"
#include "core/files/input_files.h"

namespace uw {

constexpr std::int64_t k_window_bytes = 1 << 16;

ByteReader::ByteReader(const std::filesystem::path& file, const SourceLocation& where)
    : file_(file), where_(where), stream_(file, std::ios::binary) {
    const int reason = errno;
    std::error_code error;
    if (!stream_)
        throw IoError(fmt::format("{}: cannot open '{}': {}", where, file.string(),
                                  std::generic_category().message(reason)));
    if (!std::filesystem::is_regular_file(file, error))
        throw IoError(fmt::format("{}: cannot open '{}': not a file", where, file.string()));
    remember_input(file);
    size_ = static_cast<std::int64_t>(std::filesystem::file_size(file));
}

void ByteReader::fail(const std::string& what) const {
    throw InputError(fmt::format("{}: '{}' {}", where_, file_.string(), what));
}

void ByteReader::fail_damaged() const {
    fail("is truncated or damaged; copy or export it again");
}

void ByteReader::seek(std::int64_t position) {
    if (position < 0 || position > size_) fail_damaged();
    position_ = position;
}

void ByteReader::skip(std::int64_t bytes) {
    if (bytes < 0 || bytes > size_ - position_) fail_damaged();
    position_ += bytes;
}

void ByteReader::read(char* to, std::size_t bytes) {
    const auto wanted = static_cast<std::int64_t>(bytes);
    if (wanted > size_ - position_) fail_damaged();
    const std::int64_t window_end = window_begin_ + static_cast<std::int64_t>(window_.size());
    if (position_ < window_begin_ || position_ + wanted > window_end) {
        const std::int64_t length = std::min(std::max(k_window_bytes, wanted), size_ - position_);
        window_.resize(static_cast<std::size_t>(length));
        stream_.seekg(position_);
        stream_.read(window_.data(), length);
        if (!stream_) fail_damaged();
        window_begin_ = position_;
    }
    std::memcpy(to, window_.data() + (position_ - window_begin_), bytes);
    position_ += wanted;
}

std::string ByteReader::text(std::size_t size) {
    if (size > k_longest_text) fail("is damaged: it contains an absurdly long name");
    std::string value(size, '\0');
    read(value.data(), size);
    return value;
}

}  // namespace uw
