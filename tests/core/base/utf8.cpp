// ctest labels: unit
#include "core/base/text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <initializer_list>
#include <string>

namespace uw {
namespace {

/// The bytes of a code point in the table of RFC 3629, section 3, in the number of bytes given,
/// which may be more than it needs.
std::string utf8_bytes(std::uint32_t code, int length) {
    if (length == 1) return {static_cast<char>(code)};
    std::string bytes;
    for (int i = length; i-- > 1; code >>= 6)
        bytes.insert(bytes.begin(), static_cast<char>(0x80 | (code & 0x3F)));
    const unsigned mark = (0xF00U >> length) & 0xFFU;
    return static_cast<char>(mark | code) + bytes;
}

int utf8_length(std::uint32_t code) {
    return code < 0x80 ? 1 : (code < 0x800 ? 2 : (code < 0x10000 ? 3 : 4));
}

TEST(Utf8, AllCharactersButControlsAndSurrogatesAreText) {
    for (std::uint32_t code = 0; code < 0x120000; code += code < 0x3000 ? 1 : 61) {
        const bool control =
            (code < 0x20 && code != '\t' && code != '\n' && code != '\r') || code == 0x7F;
        const bool surrogate = code >= 0xD800 && code < 0xE000;
        const std::string bytes = utf8_bytes(code, utf8_length(code));
        const bool is_text = !control && !surrogate && code < 0x110000;
        ASSERT_EQ(first_non_text(bytes), is_text ? bytes.size() : 0) << std::hex << code;
    }
}

TEST(Utf8, LimitsOfTheRanges) {
    for (const std::uint32_t code : {0xD7FFU, 0xE000U, 0xFFFFU, 0x10000U, 0x10FFFFU})
        EXPECT_EQ(first_non_text(utf8_bytes(code, utf8_length(code))),
                  static_cast<std::size_t>(utf8_length(code)));
    for (const std::uint32_t code : {0xD800U, 0xDFFFU, 0x110000U, 0x1FFFFFU})
        EXPECT_EQ(first_non_text(utf8_bytes(code, utf8_length(code))), 0U);
}

TEST(Utf8, LongerFormsThanNeededAreNone) {
    // '/' hidden from those who look for one byte is the classic of them.
    for (const std::uint32_t code : {0U, 0x2FU, 0x7FU, 0x7FFU, 0xFFFFU})
        for (int length = utf8_length(code) + 1; length <= 4; ++length)
            EXPECT_EQ(first_non_text(utf8_bytes(code, length)), 0U) << code << " in " << length;
}

TEST(Utf8, CharactersCutOffOrWithoutABeginning) {
    const std::string fish = "\xF0\x9F\x90\x9F";
    for (std::size_t length = 1; length < fish.size(); ++length) {
        EXPECT_EQ(first_non_text("ab" + fish.substr(0, length)), 2U);
        EXPECT_EQ(first_non_text("ab" + fish.substr(0, length) + "c"), 2U);
        EXPECT_EQ(first_non_text("abc" + fish.substr(length)), 3U);
    }
    EXPECT_EQ(first_non_text("a\xFF"), 1U);
    EXPECT_EQ(first_non_text("a\xFE"), 1U);
}

TEST(Utf8, TellsWhereTheFirstIs) {
    EXPECT_EQ(first_non_text(""), 0U);
    EXPECT_EQ(first_non_text("line\r\n\ttext"), 11U);
    EXPECT_EQ(first_non_text("l\xC3\xA4nge\x01\x02"), 6U);
}

}  // namespace
}  // namespace uw
