#include "edit/document/yaml_replacements.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "core/base/text.h"

namespace uw {
namespace {

/// A block below its key becomes a value beside it.
std::vector<TextChange> replaced_block(const YamlSource& source, const ConfigNode::Entry& entry,
                                       const std::string& text) {
    const YamlLayout& layout = source.layout();
    const TextSpan value = layout.value(entry);
    const std::size_t anchor = layout.anchor(value).size();
    const std::size_t beside = anchor > 0 ? value.begin + anchor : layout.after_colon(entry);
    const TextSpan lines = source.whole_lines(layout.without_anchor(value));
    if (lines.begin < beside) layout.fail(entry.position);
    return {{lines.begin, lines.size(), ""}, {beside, 0, " " + text}};
}

std::vector<TextChange> removed_from_flow(const YamlSource& source,
                                          const std::vector<TextSpan>& all, std::size_t index) {
    const TextSpan own = all[index];
    if (index + 1 < all.size()) return {{own.begin, all[index + 1].begin - own.begin, ""}};
    const std::size_t before = all[index - 1].end;
    const std::string_view between =
        std::string_view(source.text()).substr(before, own.begin - before);
    if (between.find('#') == std::string_view::npos) return {{before, own.end - before, ""}};
    // A comment behind the one before stays.
    const std::size_t comma = source.layout().skip_blanks(before);
    return {{comma, 1, ""}, {own.begin, own.size(), ""}};
}

std::vector<TextChange> removed_from_block(const YamlSource& source, TextSpan own) {
    const YamlLayout& layout = source.layout();
    const std::string& text = source.text();
    const bool is_alone = text.find_first_not_of(' ', layout.line_begin(own.begin)) == own.begin;
    if (is_alone) {
        const TextSpan lines = source.whole_lines(own);
        return {{lines.begin, lines.size(), ""}};
    }
    // The first key of an item stands behind its dash: the next one takes its place.
    const std::size_t next = text.find_first_not_of(' ', layout.next_line(own.end));
    return {{own.begin, std::min(next, text.size()) - own.begin, ""}};
}

}  // namespace

std::vector<TextChange> replaced_value(const YamlSource& source, const NodeRoute& route,
                                       const ConfigNode& value) {
    const ConfigNode& old = source.node(route);
    const ConfigNode::Entry* const entry = source.entry(route);
    const TextSpan span = source.layout().without_anchor(source.span(route));
    const WriteStyle style = source.style(route);
    std::string text = flow_text(value, style);
    const bool is_block = old.alias.line == 0 && (!old.entries.empty() || !old.items.empty()) &&
                          !source.layout().is_flow(span);
    if (is_block && entry != nullptr) return replaced_block(source, *entry, text);
    if (span.size() == 0) return {{span.begin, 0, " " + text}};
    double number = 0;
    const bool stays_in_quotes = value.kind == ConfigNode::Kind::scalar && old.quoted &&
                                 !style.is_json &&
                                 parse_number(value.scalar, number) == NumberText::no_number &&
                                 value.scalar.find_first_of("'\"\\\n\t") == std::string::npos;
    const char quote = source.text()[span.begin];
    if (stays_in_quotes && (quote == '"' || quote == '\'')) text = quote + value.scalar + quote;
    return {{span.begin, span.size(), text}};
}

std::vector<TextChange> removed_child(const YamlSource& source, const NodeRoute& parent,
                                      std::size_t child) {
    const YamlLayout& layout = source.layout();
    const ConfigNode& from = source.node(parent);
    const bool is_flow = source.is_flow(parent);
    std::vector<TextSpan> all;
    for (const ConfigNode::Entry& entry : from.entries) all.push_back(layout.entry(entry));
    for (const ConfigNode& item : from.items) {
        all.push_back(layout.item(item));
        if (!is_flow) all.back().begin = layout.dash(item);
    }
    return is_flow ? removed_from_flow(source, all, child) : removed_from_block(source, all[child]);
}

}  // namespace uw
