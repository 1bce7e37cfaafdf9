#include "edit/document/yaml_source.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/base/text.h"
#include "core/scene/yaml/yaml_document.h"

namespace uw {

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
