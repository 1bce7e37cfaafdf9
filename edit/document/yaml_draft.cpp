#include "edit/document/yaml_draft.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "edit/document/yaml_additions.h"
#include "edit/document/yaml_anchors.h"
#include "edit/document/yaml_replacements.h"

namespace uw {
namespace {

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

/// What to do first for `a`, the node at `route`, to mean the same as `b`.
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
    // Each round makes at least one node as it is to be; anchors that are handed on take their own.
    const std::size_t most_rounds = 8 + node_count(source_.tree()) + 2 * node_count(target);
    for (std::size_t round = 0; round < most_rounds; ++round) {
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
