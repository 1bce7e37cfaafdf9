#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace uw {

/// SHA-256 (FIPS 180-4) of bytes that come in parts.
class Sha256 {
  public:
    void add(std::span<const std::byte> bytes);
    void add(std::string_view text) { add(std::as_bytes(std::span(text))); }
    /// Of all bytes so far, as 64 lower-case hexadecimal digits. Nothing may be added afterwards.
    std::string digest();

  private:
    void add_block(const std::byte* block);

    std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                        0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<std::byte, 64> block_{};  // not full yet
    std::uint64_t size_ = 0;             // of all [bytes]
};

/// Of a text.
std::string sha256_of(std::string_view text);

/// Of a file's content. Throws IoError if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace uw
