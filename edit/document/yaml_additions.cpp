#include "edit/document/yaml_additions.h"

#include <algorithm>

namespace uw {
namespace {

std::string indented(std::string_view line_break, std::size_t column) {
    return std::string(line_break) + std::string(column, ' ');
}

/// Within brackets, behind the entry that ends at `after`. A comment behind the last entry stays
/// with it: what follows then begins below the one at `like_begin`.
std::vector<TextChange> inserted_in_flow(const YamlSource& source, std::size_t after, bool is_last,
                                         std::size_t like_begin, std::string_view separator,
                                         const std::string& text) {
    const std::size_t next = source.text().find_first_not_of(" \t", after);
    const bool has_comment = is_last && next != std::string::npos && source.text()[next] == '#';
    if (!has_comment) return {{after, 0, std::string(separator) + text}};
    const YamlLayout& layout = source.layout();
    const std::string new_line = indented(layout.line_break(after), layout.column(like_begin));
    return {{after, 0, ","}, {layout.line_end(next), 0, new_line + text}};
}

/// The space between the last two items of a flow list, unless there is a comment in it.
std::string separator_of(const YamlSource& source, const ConfigNode& list) {
    if (list.items.size() < 2) return ", ";
    const std::size_t from = source.layout().item(list.items[list.items.size() - 2]).end;
    const std::size_t to = source.layout().item(list.items.back()).begin;
    const std::string between = source.text().substr(from, to - from);
    return between.find('#') == std::string::npos ? between : ", ";
}

/// The end of the last line of a block list's last item. A comment that is indented deeper than the
/// dash belongs to the item.
std::size_t end_of_item(const YamlSource& source, const ConfigNode& item, std::size_t column) {
    const YamlLayout& layout = source.layout();
    const std::string& text = source.text();
    std::size_t end = layout.line_end(layout.item(item).end);
    for (std::size_t line = layout.next_line(end); line < text.size();
         line = layout.next_line(line)) {
        const std::size_t first = text.find_first_not_of(' ', line);
        if (first == std::string::npos || text[first] != '#' || first - line <= column) break;
        end = layout.line_end(line);
    }
    return end;
}

/// Whether the line above that of `offset` is empty.
bool is_below_empty_line(const YamlLayout& layout, std::size_t offset) {
    const std::size_t line = layout.line_begin(offset);
    return line > 0 && layout.line_end(line - 1) == layout.line_begin(line - 1);
}

}  // namespace

std::vector<TextChange> added_entry(const YamlSource& source, const NodeRoute& route,
                                    const std::string& key, const ConfigNode& value) {
    const YamlLayout& layout = source.layout();
    const ConfigNode& map = source.node(route);
    ConfigNode pair;
    pair.kind = ConfigNode::Kind::map;
    pair.entries.push_back({key, {}, value});
    std::string text = flow_text(pair, source.style(route));
    text = text.substr(1, text.size() - 2);
    if (map.entries.empty())
        return {{layout.without_anchor(source.span(route)).begin + 1, 0, text}};
    const bool is_flow = source.is_flow(route);
    std::size_t before = map.entries.size();
    const std::size_t rank = key_rank(key);
    for (std::size_t i = 0; i < map.entries.size(); ++i)
        if (key_rank(map.entries[i].key) <= rank) before = i;
    const std::size_t first = layout.offset(map.entries.front().position);
    const std::string new_line = indented(layout.line_break(first), layout.column(first));
    if (before == map.entries.size()) return {{first, 0, text + (is_flow ? ", " : new_line)}};
    const std::size_t end = layout.entry(map.entries[before]).end;
    if (!is_flow) return {{layout.line_end(end), 0, new_line + text}};
    return inserted_in_flow(source, end, before + 1 == map.entries.size(), first, ", ", text);
}

std::vector<TextChange> added_item(const YamlSource& source, const NodeRoute& route,
                                   const ConfigNode& value, std::size_t like, bool is_copy) {
    const YamlLayout& layout = source.layout();
    const ConfigNode& list = source.node(route);
    const ConfigNode& model = list.items[like];
    const ConfigNode& last = list.items.back();
    NodeRoute model_route = route;
    model_route.push_back(like);
    WriteStyle style = source.style(model_route);
    if (is_copy) style.aliases = &layout;
    if (source.is_flow(route)) {
        const TextSpan span = layout.item(last);
        return inserted_in_flow(source, span.end, true, span.begin, separator_of(source, list),
                                flow_text(value, style));
    }
    const std::size_t dash = layout.dash(last), column = layout.column(dash);
    const std::string line_break(layout.line_break(dash));
    const TextSpan model_span = layout.item(model);
    std::size_t gap = 2;
    if (layout.line_begin(model_span.begin) == layout.line_begin(layout.dash(model)))
        gap = model_span.begin - layout.dash(model);
    std::string text = indented(line_break, column) + "-" + std::string(gap - 1, ' ');
    const bool is_block = value.kind == ConfigNode::Kind::map && !value.entries.empty() &&
                          model.kind == ConfigNode::Kind::map && model.alias.line == 0 &&
                          !layout.is_flow(model_span);
    text += is_block ? block_text(value, &model, layout, column + gap, line_break, style)
                     : flow_text(value, style);
    const bool is_spaced = list.items.size() > 1 && is_below_empty_line(layout, dash);
    return {{end_of_item(source, last, column), 0, (is_spaced ? line_break : "") + text}};
}

std::vector<TextChange> started_list(const YamlSource& source, std::string_view key,
                                     const ConfigNode& value) {
    const YamlLayout& layout = source.layout();
    const std::string line_break(layout.line_break(0));
    const std::string text =
        indented(line_break, 2) + "- " + block_text(value, nullptr, layout, 4, line_break, {});
    const std::vector<ConfigNode::Entry>& entries = source.tree().entries;
    std::size_t before = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (entries[i].key == key) {
            const TextSpan old{layout.after_colon(entries[i]), layout.value(entries[i]).end};
            return {{old.begin, old.size(), ""}, {layout.line_end(old.end), 0, text}};
        }
        if (key_rank(entries[i].key) <= key_rank(key)) before = i;
    }
    const std::size_t end = layout.line_end(layout.entry(entries[before]).end);
    return {{end, 0, line_break + std::string(key) + ":" + text}};
}

}  // namespace uw
