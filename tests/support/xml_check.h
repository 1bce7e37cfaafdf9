#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace uw::test {

/// What keeps `text` from being well-formed XML of the plain kind that plots are (elements,
/// attributes in double quotes, the five entities; no comments, no DTD); empty if nothing does.
inline std::string xml_fault(std::string_view text) {
    const auto bad_text = [](std::string_view content) {
        for (std::size_t i = content.find('&'); i != std::string_view::npos;
             i = content.find('&', i + 1)) {
            const std::string_view entity = content.substr(i, content.find(';', i) - i + 1);
            if (entity != "&amp;" && entity != "&lt;" && entity != "&gt;" && entity != "&quot;")
                return true;
        }
        return content.find('<') != std::string_view::npos;
    };
    if (text.substr(0, 5) == "<?xml") text.remove_prefix(text.find("?>") + 2);
    std::vector<std::string> open;
    bool seen_root = false;
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t tag = text.find('<', at);
        const std::string_view content = text.substr(at, tag - at);
        if (bad_text(content)) return "text: " + std::string(content);
        if (open.empty() && content.find_first_not_of(" \n") != std::string_view::npos)
            return "text outside the root: " + std::string(content);
        if (tag == std::string_view::npos) break;
        std::size_t end = tag + 1;
        bool quoted = false;
        while (end < text.size() && (quoted || text[end] != '>')) {
            if (text[end] == '"') quoted = !quoted;
            if (text[end] == '<') return "< inside a tag";
            ++end;
        }
        if (end >= text.size()) return "a tag without end";
        std::string_view inside = text.substr(tag + 1, end - tag - 1);
        at = end + 1;
        if (bad_text(inside)) return "attribute: " + std::string(inside);
        if (inside.front() == '/') {
            if (open.empty() || open.back() != inside.substr(1))
                return "end tag without start: " + std::string(inside);
            open.pop_back();
            continue;
        }
        if (open.empty() && seen_root) return "a second root";
        seen_root = true;
        const bool empty = inside.back() == '/';
        if (!empty) open.emplace_back(inside.substr(0, inside.find(' ')));
    }
    if (!open.empty()) return "not closed: " + open.back();
    return seen_root ? "" : "no root";
}

/// How many times `part` occurs in `text`.
inline int occurrences(std::string_view text, std::string_view part) {
    int count = 0;
    for (std::size_t i = text.find(part); i != std::string_view::npos; i = text.find(part, i + 1))
        ++count;
    return count;
}

}  // namespace uw::test
