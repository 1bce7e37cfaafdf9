#include "cli/plot/svg_text.h"

#include <algorithm>

#include "core/base/utf8.h"

namespace uw {

namespace {

constexpr double k_glyph_width = 0.6;  // of the font's size

std::size_t glyph_count(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char byte) {
        return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
    }));
}

}  // namespace

double text_width(const std::string& text, double font) {
    return k_glyph_width * font * static_cast<double>(glyph_count(text));
}

std::string xml_escaped(std::string text) {
    for (std::size_t bad = first_non_text(text); bad < text.size(); bad = first_non_text(text))
        text[bad] = '?';
    std::string out;
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    }
    return out;
}

std::vector<std::string> wrapped_lines(const std::string& text, double width, double font) {
    std::vector<std::string> lines{""};
    std::size_t start = 0;
    while (start < text.size()) {
        const std::size_t end = std::min(text.find(' ', start), text.size());
        const std::string word = text.substr(start, end - start);
        if (!lines.back().empty() && text_width(lines.back() + " " + word, font) > width)
            lines.emplace_back("  " + word);
        else
            lines.back() += (lines.back().empty() ? "" : " ") + word;
        start = end + 1;
    }
    return lines;
}

}  // namespace uw
