#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/json.h"

namespace uw {

/// SHA-256 (FIPS 180-4) of bytes that come in parts.
class Sha256 {
  public:
    void add(std::span<const std::byte> bytes);
    void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
    /// The sum of all bytes so far, as 64 lower-case hexadecimal digits. Nothing may be added
    /// afterwards.
    std::string digest();

  private:
    void add_block(const std::byte* block);

    std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<std::byte, 64> block_{};  // not full yet
    std::uint64_t size_ = 0;             // of all [bytes]
};

/// The sum of a text.
std::string sha256_of(std::string_view text);

/// The sum of a file's content. Throws IoError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

static_assert(std::endian::native == std::endian::little);

/// Appends a number as its bytes, little-endian.
template <class T>
void append_bytes(std::string& text, const T& value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Appends 32-bit floats, little-endian.
inline void append_floats(std::string& text, std::span<const float> values) {
    text.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

/// A file of a data set that has been written.
struct SetFile {
    std::string role;  // its kind: "image", "depth"
    std::string path;  // relative to the set's folder, with slashes
    std::uint64_t bytes = 0;
    std::string sha256;

    friend bool operator==(const SetFile&, const SetFile&) = default;
};

Json set_file_json(const SetFile& file);
/// Throws Json::exception.
SetFile set_file_from_json(const Json& json);

/// Whether the file is in the set's folder as it was written: of its size and, with `by_content`,
/// with its checksum.
bool is_whole(const std::filesystem::path& folder, const SetFile& file, bool by_content);

/// Writes files of a data set, each whole or not at all, and keeps a list of them.
class SetFiles {
  public:
    explicit SetFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Calls `write` to write the file of this name. Throws IoError, and what `write` throws.
    void add(std::string role, std::string path,
             const std::function<void(const std::filesystem::path& file)>& write);
    /// Writes a file of these bytes. Throws IoError.
    void add_bytes(std::string role, std::string path, std::string_view bytes);
    /// Writes the bytes of another file of the set. Throws IoError.
    void add_copy(std::string role, std::string path, const std::string& from);
    /// Lists an existing file.
    void take(SetFile file) { written_.push_back(std::move(file)); }

    const std::vector<SetFile>& written() const { return written_; }
    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path folder_;
    std::vector<SetFile> written_;
};

}  // namespace uw
