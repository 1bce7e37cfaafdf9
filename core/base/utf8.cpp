#include "core/base/utf8.h"

#include <cstdint>

namespace uw {
namespace {

std::uint8_t byte_at(std::string_view bytes, std::size_t i) {
    return static_cast<std::uint8_t>(bytes[i]);
}

/// Length of the character that starts at `i`; 0 if none does (RFC 3629, section 4).
std::size_t character_length(std::string_view bytes, std::size_t i) {
    const std::uint8_t first = byte_at(bytes, i);
    if (first < 0x80) {
        const bool text =
            first >= 0x20 ? first != 0x7F : first == '\t' || first == '\n' || first == '\r';
        return text ? 1 : 0;
    }
    const std::size_t length = first >= 0xF0 ? 4 : (first >= 0xE0 ? 3 : 2);
    if (first < 0xC2 || first > 0xF4 || i + length > bytes.size()) return 0;
    for (std::size_t k = 1; k < length; ++k) {
        if ((byte_at(bytes, i + k) & 0xC0U) != 0x80U) return 0;
    }
    const std::uint8_t second = byte_at(bytes, i + 1);
    const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
    const bool outside = (first == 0xED && second > 0x9F) || (first == 0xF4 && second > 0x8F);
    return overlong || outside ? 0 : length;
}

}  // namespace

std::size_t first_non_text(std::string_view bytes) {
    std::size_t i = 0;
    while (i < bytes.size()) {
        const std::size_t length = character_length(bytes, i);
        if (length == 0) return i;
        i += length;
    }
    return i;
}

}  // namespace uw
