// ctest labels: unit
#include "core/scene/yaml/config_node.h"

#include <gtest/gtest.h>

#include <array>

#include "core/base/text.h"
#include "core/scene/yaml/yaml_document.h"

namespace uw {
namespace {

TEST(ConfigNode, numbersAreReadWhole) {
    double value = 0;
    for (const auto& [text, expected] : std::vector<std::pair<const char*, double>>{
             {"1", 1}, {"-2.5", -2.5}, {"+3", 3}, {".5", 0.5}, {"5.", 5}, {"1e3", 1000}}) {
        EXPECT_EQ(parse_number(text, value), NumberText::number) << text;
        EXPECT_EQ(value, expected) << text;
    }
    for (const char* const text :
         {"", "2m", "abc", "0x10", "1,5", "1 2", "++1", "+-1", "--1", "-", "1e", "1_000", " 1"}) {
        EXPECT_EQ(parse_number(text, value) == NumberText::number, false) << text;
    }
    for (const char* const text : {"nan", "inf", "-inf", "infinity", ".inf", "-.Inf", ".NaN"}) {
        EXPECT_EQ(parse_number(text, value), NumberText::not_finite) << text;
    }
    EXPECT_EQ(parse_number("1e999", value), NumberText::out_of_range);
}

TEST(ConfigNode, nearestWordsAreSlipsOnly) {
    constexpr std::array<std::string_view, 4> k_words{"intensity", "power", "position", "g"};
    EXPECT_EQ(nearest_word("intensty", k_words), "intensity");  // lost
    EXPECT_EQ(nearest_word("pwoer", k_words), "power");         // swapped
    EXPECT_EQ(nearest_word("Positoin", k_words), "position");   // case and swap
    EXPECT_EQ(nearest_word("x", k_words), "");                  // another word
    EXPECT_EQ(nearest_word("brightness", k_words), "");
    EXPECT_EQ(suggestion("brightness", k_words), "use one of: intensity, power, position, g");
}

TEST(ConfigNode, printableTextIsOneShortLine) {
    EXPECT_EQ(printable("a\nb\x1b[31m"), "a?b?[31m");
    EXPECT_EQ(printable("abcdef", 4), "abcd...");
    EXPECT_EQ(printable("ab\xc3\xa9", 3), "ab...") << "not inside a character";
}

TEST(ConfigNode, hashTellsTextFromNumbersAndNesting) {
    const auto hash = [](std::string_view text) { return config_hash(parse_yaml(text, "s")); };
    EXPECT_EQ(hash("{a: 1, b: 2}"), hash("b: 2.0\na: 1e0"));
    EXPECT_NE(hash("{a: 1}"), hash("{a: '1'}"));
    EXPECT_NE(hash("[[1], 2]"), hash("[1, [2]]"));
    EXPECT_NE(hash("[ab, c]"), hash("[a, bc]"));
    EXPECT_NE(hash("{a: 1}"), hash("{a: 2}"));
}

}  // namespace
}  // namespace uw
