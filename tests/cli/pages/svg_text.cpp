// ctest labels: unit
#include "cli/pages/svg_plot.h"

#include <gtest/gtest.h>

#include "tests/support/xml_check.h"

namespace uw {
namespace {

TEST(SvgText, WrapsAtSpaces) {
    const std::vector<std::string> lines = wrapped_lines("one two three four", 60, 10);
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[0], "one two");
    EXPECT_EQ(lines[1], "  three");
    EXPECT_EQ(text_width("β [1]", 10), text_width("b [1]", 10));
}

TEST(SvgText, EscapesWhatXmlReads) {
    EXPECT_EQ(xml_escaped("a < b & \"c\" > 'd'"), "a &lt; b &amp; &quot;c&quot; &gt; 'd'");
    EXPECT_EQ(xml_escaped("&amp;"), "&amp;amp;");
    EXPECT_EQ(xml_escaped(""), "");
    EXPECT_EQ(xml_escaped("β\t"), "β\t");
}

TEST(SvgText, ReplacesBytesThatAreNoText) {
    EXPECT_EQ(xml_escaped(std::string("a\0b\x01\xff\xc3", 6)), "a?b???");
    for (int byte = 0; byte < 256; ++byte) {
        const std::string text = xml_escaped(std::string("x") + static_cast<char>(byte) + "\x80");
        EXPECT_EQ(test::xml_fault("<a b=\"" + text + "\">" + text + "</a>"), "") << byte;
    }
}

TEST(SvgText, WidthGrowsWithTheFontAndTheLetters) {
    EXPECT_EQ(text_width("", 10), 0);
    EXPECT_DOUBLE_EQ(text_width("abcd", 20), 2 * text_width("abcd", 10));
    EXPECT_DOUBLE_EQ(text_width("abcd", 10), 4 * text_width("a", 10));
}

TEST(SvgText, LinesFitAndLoseNoWord) {
    const std::string text = "the volume scattering function of the water everywhere";
    for (const double width : {60.0, 120.0, 1000.0}) {
        std::string joined;
        for (const std::string& line : wrapped_lines(text, width, 10)) {
            const bool one_word = line.find(' ', 2) == std::string::npos;
            EXPECT_TRUE(one_word || text_width(line, 10) <= width + text_width("  ", 10)) << line;
            const std::size_t begin = line.find_first_not_of(' ');
            joined += (joined.empty() ? "" : " ") + line.substr(begin);
        }
        EXPECT_EQ(joined, text);
    }
    EXPECT_EQ(wrapped_lines("", 10, 10), std::vector<std::string>{""});
}

}  // namespace
}  // namespace uw
