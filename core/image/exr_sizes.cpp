#include "core/image/exr_sizes.h"

#include <array>
#include <bit>
#include <cstdint>
#include <fstream>
#include <system_error>

namespace uw {
namespace {

static_assert(std::endian::native == std::endian::little, "files are read as they lie");

template <class T>
bool take(std::istream& in, T& value) {
    return static_cast<bool>(in.read(reinterpret_cast<char*>(&value), sizeof value));
}

/// Names, of at most 255 characters, end with a zero.
bool take_name(std::istream& in, bool& is_empty) {
    std::array<char, 256> name{};
    in.getline(name.data(), name.size(), '\0');
    is_empty = name[0] == '\0';
    return static_cast<bool>(in) && !in.eof();
}

}  // namespace

bool exr_attributes_fit(const std::filesystem::path& file) {
    std::error_code error;
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(file, error));
    std::ifstream in(file, std::ios::binary);
    std::uint32_t magic = 0, version = 0;
    if (error || !take(in, magic) || !take(in, version)) return false;
    constexpr std::uint32_t k_several_parts = 0x1000;
    for (;;) {
        bool is_end = false, is_untyped = false;
        if (!take_name(in, is_end)) return false;
        if (is_end) {  // of this header; a further empty name ends those of several parts
            if ((version & k_several_parts) == 0 || in.peek() == 0) return true;
            continue;
        }
        std::int32_t size = 0;
        if (!take_name(in, is_untyped) || !take(in, size)) return false;
        if (size < 0 || size > bytes - in.tellg()) return false;
        in.seekg(size, std::ios::cur);
    }
}

}  // namespace uw
