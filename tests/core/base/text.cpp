// ctest labels: unit
#include "core/base/text.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace uw {
namespace {

constexpr std::array<std::string_view, 6> k_keys{"position",  "direction", "profile",
                                                 "intensity", "power",     "fov_x"};

TEST(Text, IsTrimmedAtItsEndsOnly) {
    EXPECT_EQ(trimmed(" \t a b\r"), "a b");
    EXPECT_EQ(trimmed("a"), "a");
    EXPECT_EQ(trimmed(" \t\r "), "");
    EXPECT_EQ(trimmed(""), "");
    EXPECT_EQ(trimmed(" a\r ", " \t"), "a\r");
}

TEST(Text, IsTakenLineByLine) {
    std::string_view text = "a\r\n\nb";
    EXPECT_EQ(take_line(text), "a\r");
    EXPECT_EQ(take_line(text), "");
    EXPECT_EQ(text, "b");
    EXPECT_EQ(take_line(text), "b");
    EXPECT_EQ(text, "");
    EXPECT_EQ(take_line(text), "");
}

TEST(Text, LosesABeginningThatItHas) {
    std::string_view text = "$F4";
    EXPECT_FALSE(take_beginning(text, "F"));
    EXPECT_EQ(text, "$F4");
    EXPECT_TRUE(take_beginning(text, "$F"));
    EXPECT_EQ(text, "4");
    EXPECT_FALSE(take_beginning(text, "44"));
}

TEST(Text, IsSplitIntoOnePartMoreThanSeparators) {
    using Parts = std::vector<std::string_view>;
    EXPECT_EQ(split("a,b", ','), (Parts{"a", "b"}));
    EXPECT_EQ(split(",a,", ','), (Parts{"", "a", ""}));
    EXPECT_EQ(split("a b", ','), Parts{"a b"});
    EXPECT_EQ(split("", ','), Parts{""});
}

TEST(Text, DiffersByCapitalsOfAsciiAlone) {
    EXPECT_EQ(lower_case("Jerlov-IC \xC3\x84"), "jerlov-ic \xC3\x84");
    EXPECT_TRUE(same_ignoring_case("NaN", "nan"));
    EXPECT_TRUE(same_ignoring_case("", ""));
    EXPECT_FALSE(same_ignoring_case("nan", "nanny"));
    EXPECT_FALSE(same_ignoring_case("@", "`"));  // 32 apart, as letters are
    EXPECT_TRUE(is_digit('0') && is_digit('9'));
    EXPECT_FALSE(is_digit('/') || is_digit(':'));
}

TEST(Text, PrintableKeepsAShortLineAsItIs) {
    EXPECT_EQ(printable("plume 1.vdb"), "plume 1.vdb");
    EXPECT_EQ(printable(""), "");
    EXPECT_EQ(printable("Gr\xC3\xBC\xC3\x9F"
                        "e"),
              "Gr\xC3\xBC\xC3\x9F"
              "e");
}

TEST(Text, PrintableReplacesControlCharacters) {
    EXPECT_EQ(printable("a\nb\tc\x7F\x1B[1m"), "a?b?c??[1m");
    EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a?b");
}

TEST(Text, PrintableCutsBetweenCharacters) {
    EXPECT_EQ(printable("abcdef", 6), "abcdef");
    EXPECT_EQ(printable("abcdefg", 6), "abcdef...");
    const std::string umlauts = "\xC3\xA4\xC3\xB6\xC3\xBC";  // two bytes each
    EXPECT_EQ(printable(umlauts, 6), umlauts);
    EXPECT_EQ(printable(umlauts, 5), "\xC3\xA4\xC3\xB6...");
    EXPECT_EQ(printable(umlauts, 1), "...");
    EXPECT_EQ(printable("ab\xC3\xA9", 3), "ab...");
    EXPECT_EQ(printable("\xF0\x9F\x90\x9F!", 3), "...");  // one character of four bytes
    EXPECT_EQ(printable(std::string(100, 'x')), std::string(60, 'x') + "...");
}

TEST(Text, NearestWordForgivesOneSlip) {
    EXPECT_EQ(nearest_word("postion", k_keys), "position");    // left out
    EXPECT_EQ(nearest_word("posittion", k_keys), "position");  // put in
    EXPECT_EQ(nearest_word("posizion", k_keys), "position");   // another
    EXPECT_EQ(nearest_word("poistion", k_keys), "position");   // swapped
    EXPECT_EQ(nearest_word("POSITION", k_keys), "position");
    EXPECT_EQ(nearest_word("intensty", k_keys), "intensity");
    EXPECT_EQ(nearest_word("pwoer", k_keys), "power");
    EXPECT_EQ(nearest_word("Positoin", k_keys), "position");  // case and swap
    EXPECT_EQ(nearest_word("fov", k_keys), "fov_x");          // its beginning
    EXPECT_EQ(nearest_word("int", k_keys), "intensity");
}

TEST(Text, NearestWordGuessesNothingFarAway) {
    EXPECT_EQ(nearest_word("colour", k_keys), "");
    EXPECT_EQ(nearest_word("x", k_keys), "");
    EXPECT_EQ(nearest_word("brightness", k_keys), "");
    EXPECT_EQ(nearest_word("", k_keys), "");
    EXPECT_EQ(nearest_word("position", {}), "");
    EXPECT_EQ(nearest_word(std::string(100000, 'p'), k_keys), "");
}

TEST(Text, NearestWordPrefersTheNearest) {
    constexpr std::array<std::string_view, 3> k_near{"lamps", "lamp", "clamp"};
    EXPECT_EQ(nearest_word("lmap", k_near), "lamp");
    EXPECT_EQ(nearest_word("lapms", k_near), "lamps");
}

TEST(Text, SuggestionNamesOneOrAll) {
    constexpr std::array<std::string_view, 2> k_two{"node", "cell"};
    EXPECT_EQ(suggestion("nod", k_two), "did you mean 'node'?");
    EXPECT_EQ(suggestion("corner", k_two), "use one of: node, cell");
}

struct NumberCase {
    std::string_view text;
    NumberText outcome;
    double value = 0;
};

TEST(Text, ParseNumberReadsAllOfTheText) {
    for (const NumberCase& c :
         std::initializer_list<NumberCase>{{"0", NumberText::number, 0},
                                           {"+1.5", NumberText::number, 1.5},
                                           {"-.5e-3", NumberText::number, -0.0005},
                                           {"1E6", NumberText::number, 1e6},
                                           {"0.1", NumberText::number, 0.1},
                                           {"", NumberText::no_number},
                                           {"+", NumberText::no_number},
                                           {"-", NumberText::no_number},
                                           {"+-1", NumberText::no_number},
                                           {"++1", NumberText::no_number},
                                           {"1 ", NumberText::no_number},
                                           {" 1", NumberText::no_number},
                                           {"1,5", NumberText::no_number},
                                           {"1.5m", NumberText::no_number},
                                           {"0x10", NumberText::no_number},
                                           {"1e", NumberText::no_number},
                                           {"one", NumberText::no_number},
                                           {"2m", NumberText::no_number},
                                           {"--1", NumberText::no_number},
                                           {"1_000", NumberText::no_number},
                                           {"1 2", NumberText::no_number},
                                           {"5.", NumberText::number, 5},
                                           {"infinity", NumberText::not_finite},
                                           {"-inf", NumberText::not_finite},
                                           {"1e999", NumberText::out_of_range},
                                           {"inf", NumberText::not_finite},
                                           {"-.inf", NumberText::not_finite},
                                           {".inf", NumberText::not_finite},
                                           {"-.Inf", NumberText::not_finite},
                                           {".NaN", NumberText::not_finite},
                                           {"abc", NumberText::no_number},
                                           {"1", NumberText::number, 1},
                                           {"-2.5", NumberText::number, -2.5},
                                           {"+3", NumberText::number, 3},
                                           {".5", NumberText::number, 0.5},
                                           {"1e3", NumberText::number, 1000},
                                           {"+.INF", NumberText::not_finite},
                                           {".nan", NumberText::not_finite},
                                           {"nan", NumberText::not_finite},
                                           {"1e400", NumberText::out_of_range},
                                           {"-1e400", NumberText::out_of_range}}) {
        double value = 7;
        EXPECT_EQ(parse_number(c.text, value), c.outcome) << c.text;
        EXPECT_EQ(value, c.outcome == NumberText::number ? c.value : 7) << c.text;
    }
}

TEST(Text, ParseNumberMakesMinusZeroZero) {
    double value = 7;
    EXPECT_EQ(parse_number("-0.0", value), NumberText::number);
    EXPECT_FALSE(std::signbit(value));
}

}  // namespace
}  // namespace uw
