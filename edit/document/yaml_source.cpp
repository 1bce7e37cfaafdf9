#include "edit/document/yaml_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/yaml_document.h"

namespace uw {

namespace {

constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/// The characters that end the name of an anchor or alias.
bool ends_name(char c) {
    return c == '\0' || is_blank(c) || std::string_view(",[]{}").find(c) != std::string_view::npos;
}

}  // namespace

YamlLayout::YamlLayout(std::string_view text) : text_(text) {
    // The parser does not count the mark as part of the first line.
    lines_.push_back(text.starts_with(k_byte_order_mark) ? k_byte_order_mark.size() : 0);
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '\n') lines_.push_back(i + 1);
}

void YamlLayout::fail(const ConfigPosition& position) const {
    throw InputError(fmt::format(
        "{}: is laid out in a way that cannot be edited in place; write it as key: value",
        position.text()));
}

std::size_t YamlLayout::offset(const ConfigPosition& position) const {
    const std::size_t line = static_cast<std::size_t>(position.line) - 1;
    if (position.line < 1 || line >= lines_.size()) fail(position);
    return std::min(lines_[line] + static_cast<std::size_t>(position.column) - 1, text_.size());
}

std::size_t YamlLayout::line_begin(std::size_t offset) const {
    return *std::prev(std::upper_bound(lines_.begin() + 1, lines_.end(), offset));
}

std::size_t YamlLayout::line_end(std::size_t offset) const {
    const std::size_t end = std::min(text_.find('\n', offset), text_.size());
    return end > offset && end < text_.size() && text_[end - 1] == '\r' ? end - 1 : end;
}

std::size_t YamlLayout::next_line(std::size_t offset) const {
    const std::size_t end = text_.find('\n', offset);
    return end == std::string_view::npos ? text_.size() : end + 1;
}

std::string_view YamlLayout::line_break(std::size_t offset) const {
    std::size_t end = text_.find('\n', offset);
    if (end == std::string_view::npos) end = text_.rfind('\n');
    return end != std::string_view::npos && end > 0 && text_[end - 1] == '\r' ? "\r\n" : "\n";
}

std::size_t YamlLayout::skip_blanks(std::size_t offset) const {
    while (offset < text_.size()) {
        if (text_[offset] == '#')
            offset = line_end(offset);
        else if (is_blank(text_[offset]))
            ++offset;
        else
            break;
    }
    return offset;
}

std::string_view YamlLayout::anchor(TextSpan span) const {
    if (at(span.begin) != '&') return {};
    std::size_t end = span.begin;
    while (!ends_name(at(end))) ++end;
    return text_.substr(span.begin, end - span.begin);
}

TextSpan YamlLayout::without_anchor(TextSpan span) const {
    const std::size_t length = anchor(span).size();
    if (length == 0) return span;
    return {std::min(skip_blanks(span.begin + length), span.end), span.end};
}

bool YamlLayout::is_flow(TextSpan span) const {
    const char first = at(without_anchor(span).begin);
    return first == '[' || first == '{';
}

TextSpan YamlLayout::key(const ConfigNode::Entry& entry) const {
    const std::size_t begin = offset(entry.position);
    const char first = at(begin);
    if (first == '"' || first == '\'') return {begin, end_of_quoted(begin)};
    if (text_.substr(begin, entry.key.size()) != entry.key) fail(entry.position);
    return {begin, begin + entry.key.size()};
}

std::size_t YamlLayout::after_colon(const ConfigNode::Entry& entry) const {
    std::size_t colon = key(entry).end;
    while (at(colon) == ' ' || at(colon) == '\t') ++colon;
    if (at(colon) != ':') fail(entry.position);
    return colon + 1;
}

TextSpan YamlLayout::value(const ConfigNode::Entry& entry) const {
    const ConfigNode& node = entry.value;
    const std::size_t colon = after_colon(entry);
    if (node.kind == ConfigNode::Kind::null && node.alias.line == 0) {
        // The parser does not say where nothing is.
        std::size_t begin = colon;
        while (at(begin) == ' ' || at(begin) == '\t') ++begin;
        if (at(begin) == '&' || at(begin) == '!') fail(entry.position);
        std::size_t end = begin;
        while (!ends_name(at(end)) && at(end) != '#') ++end;
        return end > begin ? TextSpan{begin, end} : TextSpan{colon, colon};
    }
    return value_from(node, offset(node.alias.line > 0 ? node.alias : node.position),
                      column(offset(entry.position)));
}

TextSpan YamlLayout::entry(const ConfigNode::Entry& entry) const {
    return {offset(entry.position), value(entry).end};
}

TextSpan YamlLayout::item(const ConfigNode& item) const {
    if (item.kind == ConfigNode::Kind::null && item.alias.line == 0) {
        const std::size_t begin = offset(item.position);
        std::size_t end = begin;
        while (!ends_name(at(end))) ++end;
        const std::string_view word = text_.substr(begin, end - begin);
        if (word != "null" && word != "~" && word != "Null" && word != "NULL") fail(item.position);
        return {begin, end};
    }
    const std::size_t begin = offset(item.alias.line > 0 ? item.alias : item.position);
    // Only a block of text needs to know how far its list is indented.
    const std::size_t indent = at(begin) == '|' || at(begin) == '>' ? column(dash(item)) : 0;
    return value_from(item, begin, indent);
}

std::size_t YamlLayout::dash(const ConfigNode& item) const {
    std::size_t before = offset(item.alias.line > 0 ? item.alias : item.position);
    while (before > 0 && is_blank(text_[before - 1])) --before;
    if (before == 0 || text_[before - 1] != '-') fail(item.position);
    return before - 1;
}

TextSpan YamlLayout::value_from(const ConfigNode& node, std::size_t begin,
                                std::size_t indent) const {
    if (node.alias.line > 0) {
        if (at(begin) != '*') fail(node.alias);
        std::size_t end = begin;
        while (!ends_name(at(end))) ++end;
        return {begin, end};
    }
    const std::size_t content = without_anchor({begin, text_.size()}).begin;
    if (at(content) == '!') fail(node.position);
    if (node.kind == ConfigNode::Kind::scalar) return {begin, end_of_scalar(node, content, indent)};
    return {begin, end_of_collection(node, content)};
}

std::size_t YamlLayout::end_of_scalar(const ConfigNode& node, std::size_t begin,
                                      std::size_t indent) const {
    if (!node.quoted) return end_of_plain(node, begin);
    if (at(begin) == '|' || at(begin) == '>') return end_of_text_block(begin, indent);
    if (at(begin) != '"' && at(begin) != '\'') fail(node.position);
    return end_of_quoted(begin);
}

// Plain text has no escapes: but for white space, where lines are joined, it is what was read.
std::size_t YamlLayout::end_of_plain(const ConfigNode& node, std::size_t begin) const {
    std::size_t end = begin;
    for (const char c : node.scalar) {
        if (is_blank(c)) continue;
        while (is_blank(at(end))) ++end;
        if (at(end) != c) fail(node.position);
        ++end;
    }
    return end;
}

std::size_t YamlLayout::end_of_quoted(std::size_t begin) const {
    const char quote = at(begin);
    for (std::size_t i = begin + 1; i < text_.size(); ++i) {
        if (quote == '"' && text_[i] == '\\') {
            ++i;
        } else if (text_[i] == quote) {
            if (quote == '"' || at(i + 1) != quote) return i + 1;
            ++i;
        }
    }
    return text_.size();
}

// A block has the lines that are indented deeper than its key, and blank ones but for those at its
// end.
std::size_t YamlLayout::end_of_text_block(std::size_t begin, std::size_t indent) const {
    std::size_t end = line_end(begin);
    for (std::size_t line = next_line(begin); line < text_.size(); line = next_line(line)) {
        std::size_t first = line;
        while (at(first) == ' ') ++first;
        const bool is_empty = first >= line_end(line);
        if (!is_empty && first - line <= indent) break;
        if (!is_empty) end = line_end(line);
    }
    return end;
}

std::size_t YamlLayout::end_of_collection(const ConfigNode& node, std::size_t begin) const {
    const bool is_map = node.kind == ConfigNode::Kind::map;
    const char closing = at(begin) == '[' ? ']' : '}';
    const bool has_brackets = at(begin) == (is_map ? '{' : '[');
    std::size_t end = begin + (has_brackets ? 1 : 0);
    if (is_map && !node.entries.empty()) {
        // A flow list may hold "key: value" without braces, and a key nothing else.
        const ConfigNode::Entry& last = node.entries.back();
        const std::size_t after_key = skip_blanks(key(last).end);
        const bool has_colon = at(after_key) == ':';
        end = has_colon ? value(last).end : key(last).end;
    } else if (!is_map && !node.items.empty()) {
        end = item(node.items.back()).end;
    }
    if (!has_brackets) return end;
    end = skip_blanks(end);
    if (at(end) == ',') end = skip_blanks(end + 1);
    if (at(end) != closing) fail(node.position);
    return end + 1;
}

namespace {

/// The entries of `map` in the order of `like` as far as it has them, then by rank.
std::vector<const ConfigNode::Entry*> in_order(const ConfigNode& map, const ConfigNode* like) {
    const auto place = [like](const ConfigNode::Entry* entry) {
        const std::size_t rank = key_rank(entry->key);
        if (like == nullptr) return rank;
        // The entry goes next to the nearest key of lower rank that is there.
        std::size_t best = 0;
        for (std::size_t i = 0; i < like->entries.size(); ++i) {
            if (like->entries[i].key == entry->key) return 2 * i + 1;
            if (key_rank(like->entries[i].key) <= rank) best = 2 * i + 2;
        }
        return best;
    };
    std::vector<const ConfigNode::Entry*> entries = entries_by_rank(map);
    std::ranges::stable_sort(entries, {}, place);
    return entries;
}

}  // namespace

std::string flow_text(const ConfigNode& value, const WriteStyle& style) {
    FlowStyle flow{.is_json = style.is_json};
    if (style.aliases != nullptr)
        flow.alias_text = [&layout = *style.aliases](const ConfigNode& alias) {
            const TextSpan span = layout.item(alias);
            return std::string(layout.text().substr(span.begin, span.size()));
        };
    return flow_text(value, flow);
}

std::string block_text(const ConfigNode& map, const ConfigNode* like, const YamlLayout& source,
                       std::size_t column, std::string_view line_break, const WriteStyle& style) {
    std::string text;
    const std::string new_line = std::string(line_break) + std::string(column, ' ');
    const ConfigNode* const model =
        like != nullptr && like->kind == ConfigNode::Kind::map ? like : nullptr;
    for (const ConfigNode::Entry* entry : in_order(map, model)) {
        if (!text.empty()) text += new_line;
        text += quoted_if_needed(entry->key, style.is_json) + ":";
        const ConfigNode& value = entry->value;
        const ConfigNode* const same = model != nullptr ? model->find(entry->key) : nullptr;
        const bool is_alias = value.alias.line > 0 && style.aliases != nullptr;
        const bool is_block = same != nullptr && same->alias.line == 0 && !is_alias &&
                              same->kind == ConfigNode::Kind::map && !same->entries.empty() &&
                              value.kind == ConfigNode::Kind::map && !value.entries.empty() &&
                              !source.is_flow(source.item(*same));
        if (!is_block) {
            text += " " + flow_text(value, style);
            continue;
        }
        const std::size_t own = source.column(source.offset(model->entries.front().position));
        const std::size_t theirs = source.column(source.offset(same->entries.front().position));
        const std::size_t inner = column + (theirs > own ? theirs - own : 2);
        text += std::string(line_break) + std::string(inner, ' ') +
                block_text(value, same, source, inner, line_break, style);
    }
    return text;
}

const ConfigNode& child_of(const ConfigNode& node, std::size_t index) {
    return node.kind == ConfigNode::Kind::map ? node.entries[index].value : node.items[index];
}

const ConfigNode& node_at(const ConfigNode& root, const NodeRoute& route) {
    const ConfigNode* node = &root;
    for (const std::size_t index : route) node = &child_of(*node, index);
    return *node;
}

bool means_the_same(const ConfigNode& a, const ConfigNode& b) {
    if (a.kind != b.kind || a.items.size() != b.items.size() ||
        a.entries.size() != b.entries.size())
        return false;
    if (a.kind == ConfigNode::Kind::scalar) {
        double x = 0, y = 0;
        const bool a_is_number = !a.quoted && parse_number(a.scalar, x) == NumberText::number;
        const bool b_is_number = !b.quoted && parse_number(b.scalar, y) == NumberText::number;
        if (a_is_number != b_is_number) return false;
        return a_is_number ? x == y : a.scalar == b.scalar;
    }
    for (std::size_t i = 0; i < a.items.size(); ++i)
        if (!means_the_same(a.items[i], b.items[i])) return false;
    return std::ranges::all_of(a.entries, [&b](const ConfigNode::Entry& entry) {
        const ConfigNode* const other = b.find(entry.key);
        return other != nullptr && means_the_same(entry.value, *other);
    });
}

YamlSource::YamlSource(std::string text, std::string origin, ConfigNode tree)
    : text_(std::move(text)), origin_(std::move(origin)), tree_(std::move(tree)), layout_(text_) {}

void YamlSource::apply(std::vector<TextChange> changes) {
    std::ranges::stable_sort(changes, std::ranges::greater{}, &TextChange::offset);
    for (const TextChange& change : changes)
        text_.replace(change.offset, change.length, change.text);
    tree_ = parse_yaml(text_, origin_);
    layout_ = YamlLayout(text_);
}

const ConfigNode::Entry* YamlSource::entry(const NodeRoute& route) const {
    if (route.empty()) return nullptr;
    const ConfigNode& parent = node({route.begin(), route.end() - 1});
    return parent.kind == ConfigNode::Kind::map ? &parent.entries[route.back()] : nullptr;
}

TextSpan YamlSource::span(const NodeRoute& route) const {
    if (route.empty()) return {layout_.offset(tree_.position), text_.size()};
    const ConfigNode::Entry* const found = entry(route);
    return found != nullptr ? layout_.value(*found) : layout_.item(node(route));
}

bool YamlSource::is_flow(const NodeRoute& route) const {
    return layout_.is_flow(span(route));
}

TextSpan YamlSource::whole_lines(TextSpan span) const {
    std::size_t begin = layout_.line_begin(span.begin);
    const std::size_t end = layout_.next_line(span.end);
    const bool is_unfinished = end == text_.size() && !text_.ends_with('\n');
    if (is_unfinished && begin > 0) begin = layout_.line_end(begin - 1);
    return {begin, end};
}

WriteStyle YamlSource::style(const NodeRoute& route) const {
    WriteStyle found;
    const ConfigNode* at = &tree_;
    for (std::size_t i = 0;; ++i) {
        if (at->kind == ConfigNode::Kind::map && !at->entries.empty())
            found.is_json = std::ranges::all_of(at->entries, [this](const auto& entry) {
                return text_[layout_.offset(entry.position)] == '"';
            });
        if (i == route.size()) return found;
        at = &child_of(*at, route[i]);
        if (at->alias.line > 0) return found;
    }
}

}  // namespace uw
