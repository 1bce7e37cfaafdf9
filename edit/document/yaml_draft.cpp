#include "edit/document/yaml_draft.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/text.h"

namespace uw {

namespace {

/// The positions of all aliases of the value that begins at `definition`.
void find_aliases(const ConfigNode& node, const ConfigPosition& definition,
                  const YamlLayout& layout, std::vector<std::size_t>& found) {
    if (node.alias.line > 0 && node.position.line == definition.line &&
        node.position.column == definition.column)
        found.push_back(layout.offset(node.alias));
    for (const ConfigNode& item : node.items) find_aliases(item, definition, layout, found);
    for (const ConfigNode::Entry& entry : node.entries)
        find_aliases(entry.value, definition, layout, found);
}

/// All nodes that are written in place rather than through an alias.
void collect(const ConfigNode& node, std::vector<const ConfigNode*>& nodes) {
    if (node.alias.line > 0) return;
    nodes.push_back(&node);
    for (const ConfigNode& item : node.items) collect(item, nodes);
    for (const ConfigNode::Entry& entry : node.entries) collect(entry.value, nodes);
}

std::vector<const ConfigNode*> nodes_to_release(const YamlSource& source, const NodeRoute& route,
                                                bool with_all_below) {
    std::vector<const ConfigNode*> nodes;
    const ConfigNode* node = &source.tree();
    for (const std::size_t index : route) {
        node = &child_of(*node, index);
        if (node->alias.line > 0) return nodes;
        nodes.push_back(node);
    }
    if (with_all_below) collect(*node, nodes);
    return nodes;
}

struct SharedAnchor {
    const ConfigNode* node = nullptr;
    std::size_t first_alias = 0;
};

/// The first of them that has an alias outside `own`.
SharedAnchor shared_anchor(const YamlSource& source, const std::vector<const ConfigNode*>& nodes,
                           TextSpan own) {
    const YamlLayout& layout = source.layout();
    for (const ConfigNode* const node : nodes) {
        if (layout.anchor({layout.offset(node->position), source.text().size()}).empty()) continue;
        std::vector<std::size_t> aliases;
        find_aliases(source.tree(), node->position, layout, aliases);
        std::erase_if(aliases, [own](std::size_t alias) { return own.contains(alias); });
        if (!aliases.empty()) return {node, *std::ranges::min_element(aliases)};
    }
    return {};
}

/// Hands on the anchors of all values on the way to `route`, and of all below it if
/// `with_all_below`, that aliases elsewhere stand for: the first alias becomes the anchor, with the
/// value as it is now. A change there then changes nothing else. The document means the same.
void release_anchors(YamlSource& source, const NodeRoute& route, bool with_all_below) {
    while (true) {
        const TextSpan own = with_all_below ? source.span(route) : TextSpan{};
        const SharedAnchor shared =
            shared_anchor(source, nodes_to_release(source, route, with_all_below), own);
        if (shared.node == nullptr) return;
        const std::string& text = source.text();
        const std::size_t begin = source.layout().offset(shared.node->position);
        const std::string name(source.layout().anchor({begin, text.size()}));
        std::size_t from = begin, to = begin + name.size();
        if (text[to] == ' ')
            while (text[to] == ' ') ++to;
        else
            while (from > 0 && text[from - 1] == ' ') --from;
        const std::string value = flow_text(*shared.node, {.aliases = &source.layout()});
        source.apply(
            {{from, to - from, ""}, {shared.first_alias, name.size(), name + " " + value}});
    }
}

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
    // A comment behind the entry before stays.
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

/// Puts another value at `route`, on one line. A text stays in its quotes, an anchor in its place.
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

/// Takes one of several entries out of the map or list at `parent`. Comments around it stay.
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

std::string indented(std::string_view line_break, std::size_t column) {
    return std::string(line_break) + std::string(column, ' ');
}

/// Inserts `text` within brackets, behind the entry that ends at `after`. A comment behind the last
/// entry stays with it: what follows then begins below the one at `like_begin`.
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

/// Adds a key with its value to the map at `route`, behind the keys that usually come before it.
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

/// As YamlDraft::append.
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

/// As YamlDraft::start_list.
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

struct Difference {
    enum class Kind { replace, add_entry, add_item, remove } kind;
    NodeRoute route;
    const ConfigNode* value = nullptr;  // of the target
    const std::string* key = nullptr;
};

std::size_t node_count(const ConfigNode& node) {
    std::size_t count = 1;
    for (const ConfigNode& item : node.items) count += node_count(item);
    for (const ConfigNode::Entry& entry : node.entries) count += node_count(entry.value);
    return count;
}

/// The first change that makes `a`, the node at `route`, more like `b`.
std::optional<Difference> first_difference(const ConfigNode& a, const ConfigNode& b,
                                           NodeRoute& route) {
    using Kind = Difference::Kind;
    if (means_the_same(a, b)) return std::nullopt;
    const auto at = [&route](std::size_t index) {
        NodeRoute longer = route;
        longer.push_back(index);
        return longer;
    };
    const auto below = [&](std::size_t index, const ConfigNode& value) {
        route.push_back(index);
        std::optional<Difference> found = first_difference(child_of(a, index), value, route);
        route.pop_back();
        return found;
    };
    const bool is_alias = a.alias.line > 0;
    if (a.kind == ConfigNode::Kind::map && b.kind == a.kind && !is_alias && !b.entries.empty()) {
        for (std::size_t i = 0; i < a.entries.size(); ++i)
            if (const ConfigNode* const value = b.find(a.entries[i].key))
                if (auto found = below(i, *value)) return found;
        for (const ConfigNode::Entry& entry : b.entries)
            if (a.find(entry.key) == nullptr)
                return Difference{Kind::add_entry, route, &entry.value, &entry.key};
        for (std::size_t i = 0; i < a.entries.size(); ++i)
            if (b.find(a.entries[i].key) == nullptr) return Difference{Kind::remove, at(i)};
    }
    const bool both_lists = a.kind == ConfigNode::Kind::sequence && b.kind == a.kind;
    if (both_lists && !is_alias && !a.items.empty() && !b.items.empty()) {
        for (std::size_t i = 0; i < std::min(a.items.size(), b.items.size()); ++i)
            if (auto found = below(i, b.items[i])) return found;
        if (a.items.size() > b.items.size())
            return Difference{Kind::remove, at(a.items.size() - 1)};
        return Difference{Kind::add_item, route, &b.items[a.items.size()]};
    }
    return Difference{Kind::replace, route, &b};
}

}  // namespace

YamlDraft::YamlDraft(std::string text, std::string origin, ConfigNode tree)
    : source_(std::move(text), std::move(origin), std::move(tree)) {}

void YamlDraft::become(const ConfigNode& target) {
    // Each round corrects at least one node; passing on anchors takes rounds of its own.
    const std::size_t max_rounds = 8 + node_count(source_.tree()) + 2 * node_count(target);
    for (std::size_t round = 0; round < max_rounds; ++round) {
        NodeRoute start;
        const std::optional<Difference> found = first_difference(source_.tree(), target, start);
        if (!found) return;
        switch (found->kind) {
            case Difference::Kind::replace:
                replace(found->route, *found->value);
                break;
            case Difference::Kind::add_entry:
                add_entry(found->route, *found->key, *found->value);
                break;
            case Difference::Kind::add_item:
                append(found->route, *found->value, source_.node(found->route).items.size() - 1);
                break;
            case Difference::Kind::remove:
                remove(found->route);
                break;
        }
    }
}

void YamlDraft::replace(const NodeRoute& route, const ConfigNode& value) {
    release_anchors(source_, route, true);
    source_.apply(replaced_value(source_, route, value));
}

void YamlDraft::add_entry(const NodeRoute& route, const std::string& key, const ConfigNode& value) {
    release_anchors(source_, route, false);
    source_.apply(added_entry(source_, route, key, value));
}

void YamlDraft::append(const NodeRoute& list, const ConfigNode& value, std::size_t like,
                       bool is_copy) {
    release_anchors(source_, list, false);
    source_.apply(added_item(source_, list, value, like, is_copy));
}

void YamlDraft::start_list(std::string_view key, const ConfigNode& value) {
    source_.apply(started_list(source_, key, value));
}

void YamlDraft::remove(const NodeRoute& route) {
    release_anchors(source_, route, true);
    const NodeRoute parent_route(route.begin(), route.end() - 1);
    const ConfigNode& parent = source_.node(parent_route);
    if (parent.items.size() + parent.entries.size() > 1) {
        source_.apply(removed_child(source_, parent_route, route.back()));
        return;
    }
    ConfigNode empty;
    empty.kind = parent.kind;
    replace(parent_route, empty);
}

}  // namespace uw
