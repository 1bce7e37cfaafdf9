#include "edit/document/yaml_anchors.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace uw {
namespace {

/// Every place at which an alias stands for the value that begins at `definition`.
void find_aliases(const ConfigNode& node, const ConfigPosition& definition,
                  const YamlLayout& layout, std::vector<std::size_t>& found) {
    if (node.alias.line > 0 && node.position.line == definition.line &&
        node.position.column == definition.column)
        found.push_back(layout.offset(node.alias));
    for (const ConfigNode& item : node.items) find_aliases(item, definition, layout, found);
    for (const ConfigNode::Entry& entry : node.entries)
        find_aliases(entry.value, definition, layout, found);
}

/// All that is written at its place, not reached through an alias.
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

/// The first of them that an alias outside `own` stands for.
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

}  // namespace

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

}  // namespace uw
