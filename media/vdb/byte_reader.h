#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/scene/source_location.h"

namespace uw {

static_assert(std::endian::native == std::endian::little, "files are read as they lie");

/// Reads a little-endian binary file sequentially and never trusts a size that the file cannot
/// hold. Errors in the file become a one-line InputError that starts with `where`.
class ByteReader {
  public:
    static constexpr std::size_t k_longest_text = 4096;

    /// Throws IoError if the file cannot be opened. `file` and `where` must outlive the reader.
    ByteReader(const std::filesystem::path& file, const SourceLocation& where);

    std::int64_t size() const { return size_; }
    std::int64_t position() const { return position_; }

    /// Throws InputError: "<where>: '<file>' <what>".
    [[noreturn]] void fail(const std::string& what) const;
    [[noreturn]] void fail_damaged() const;

    void seek(std::int64_t position);
    void skip(std::int64_t bytes);

    template <class T>
    T get() {
        T value{};
        read(reinterpret_cast<char*>(&value), sizeof value);
        return value;
    }
    void read(char* to, std::size_t bytes);
    std::string text(std::size_t size);
    std::string text() { return text(get<std::uint32_t>()); }  // prefixed by its length

  private:
    const std::filesystem::path& file_;
    const SourceLocation& where_;
    std::ifstream stream_;
    std::vector<char>
        window_;  // the file's bytes from window_begin_ on, so that short seeks are cheap
    std::int64_t window_begin_ = 0;
    std::int64_t size_ = 0, position_ = 0;
};

}  // namespace uw
