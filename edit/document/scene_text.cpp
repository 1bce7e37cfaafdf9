#include "edit/document/scene_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/key_path.h"
#include "core/scene/yaml_document.h"
#include "edit/document/yaml_draft.h"

namespace uw {

namespace {

/// The entry of `geometry` that asks for its file's cameras or lamps; nullptr if none does.
const ConfigNode* asking_for(const ConfigNode& root, std::string_view what) {
    const ConfigNode* const geometry = root.find("geometry");
    if (geometry == nullptr) return nullptr;
    for (const ConfigNode& entry : geometry->items) {
        const ConfigNode* const value = entry.find(what);
        if (value != nullptr && value->scalar != "false") return &entry;
    }
    return nullptr;
}

bool has_entry(const ConfigNode* list, std::string_view name) {
    if (list == nullptr) return false;
    for (std::size_t i = 0; i < list->items.size(); ++i)
        if (entry_name(*list, i, "lamps") == name) return true;
    return false;
}

/// Throws InputError, one line with the reason, if the scene takes the lamp, the pose or the
/// intrinsics at `path` from a glTF file: they are not in the scene file, and cannot be changed
/// there.
void check_not_of_gltf(const ConfigNode& root, std::string_view path) {
    const std::vector<KeyStep> steps = parse_key_path(path);
    if (steps.size() < 2 || steps[1].index) return;
    const ConfigNode* const section = root.find(steps[0].key);
    const std::string& key = steps[1].key;
    const ConfigNode* source = nullptr;
    std::string asked;
    if (steps[0].key == "lamps" && !has_entry(section, key)) {
        source = asking_for(root, asked = "lamps");
    } else if (steps[0].key == "camera" && (key == "pose" || key == "intrinsics") &&
               (section == nullptr || section->find(key) == nullptr)) {
        source = asking_for(root, asked = "camera");
    }
    if (source == nullptr) return;
    const ConfigNode* const file = source->find("file");
    throw InputError(fmt::format(
        "{}: {}.{}: is not in this file: '{}' asks for what is in {}; change it there, with the "
        "program that made it",
        source->position.text(), steps[0].key, printable(key), asked,
        file != nullptr ? printable(file->scalar) : "its glTF file"));
}

/// The way to the node at `path`; empty if there is none, or for the root.
NodeRoute route_to(const ConfigNode& root, std::string_view path) {
    NodeRoute route;
    const ConfigNode* node = &root;
    const std::vector<KeyStep> steps = parse_key_path(path);
    std::string walked;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const std::size_t count =
            node->kind == ConfigNode::Kind::map ? node->entries.size() : node->items.size();
        std::size_t index = count;
        if (steps[i].is_any) return {};
        if (steps[i].index && node->kind != ConfigNode::Kind::map) {
            if (node->kind == ConfigNode::Kind::sequence) index = *steps[i].index;
        } else if (node->kind == ConfigNode::Kind::map) {
            const std::string key = joined_key(*node, steps, i);
            for (index = 0; index < count && node->entries[index].key != key;) ++index;
        } else {
            // No node here is used in more than one place, and entries may have no name.
            const std::string& name = steps[i].key;
            for (index = name.empty() ? count : 0;
                 index < count && entry_name(*node, index, walked) != name;)
                ++index;
        }
        if (index >= count) return {};
        route.push_back(index);
        node = &child_of(*node, index);
        walked += (walked.empty() || steps[i].index ? "" : ".") + steps[i].text();
    }
    return route;
}

/// Throws if there is no such entry.
NodeRoute require(const SceneText& scene, std::string_view path) {
    if (parse_key_path(path).empty())
        throw UsageError(
            fmt::format("{}: not of the form key.path, such as lamps[0].power", printable(path)));
    NodeRoute route = route_to(scene.tree(), path);
    if (!route.empty()) return route;
    check_not_of_gltf(scene.tree(), path);
    throw InputError(fmt::format("{}: {}: there is no such key", scene.origin(), printable(path)));
}

ConfigNode& node_in(ConfigNode& root, const NodeRoute& route) {
    return const_cast<ConfigNode&>(node_at(root, route));  // what it is part of is not const
}

/// Whether the node at `route` is written in place rather than through an alias.
bool is_written_there(const ConfigNode& root, const NodeRoute& route) {
    const ConfigNode* node = &root;
    return std::ranges::all_of(route, [&node](std::size_t index) {
        node = &child_of(*node, index);
        return node->alias.line == 0;
    });
}

bool is_in_list(const ConfigNode& root, const NodeRoute& route) {
    return !route.empty() &&
           node_at(root, {route.begin(), route.end() - 1}).kind == ConfigNode::Kind::sequence;
}

/// Numbers as `style` writes them.
void spell_numbers(ConfigNode& node, const NumberStyle& style) {
    double number = 0;
    const bool is_plain = node.kind == ConfigNode::Kind::scalar && !node.quoted;
    if (is_plain && parse_number(node.scalar, number) == NumberText::number)
        node.scalar = number_text(number, style);
    for (ConfigNode& item : node.items) spell_numbers(item, style);
    for (ConfigNode::Entry& entry : node.entries) spell_numbers(entry.value, style);
}

ConfigNode parse_value(std::string_view value, std::string_view path, const NumberStyle& style) {
    ConfigNode node = parse_yaml_value(value, printable(path));
    spell_numbers(node, style);
    return node;
}

ConfigNode text_node(std::string_view text) {
    ConfigNode node;
    node.kind = ConfigNode::Kind::scalar;
    node.quoted = true;
    node.scalar = text;
    return node;
}

}  // namespace

SceneText::SceneText(std::string text, std::string origin)
    : text_(std::move(text)), origin_(std::move(origin)), tree_(parse_yaml(text_, origin_)) {}

const ConfigNode* SceneText::find(std::string_view path) const {
    const NodeRoute route = route_to(tree_, path);
    return route.empty() ? nullptr : &node_at(tree_, route);
}

void SceneText::take(const YamlDraft& draft, const ConfigNode& intended, std::string_view path) {
    if (!means_the_same(draft.tree(), intended))
        throw InputError(fmt::format(
            "{}: {}: cannot be changed in place without changing other values; edit the file",
            origin_, printable(path)));
    text_ = draft.text();
    tree_ = draft.tree();
}

void SceneText::set(std::string_view path, std::string_view value, const NumberStyle& style) {
    check_not_of_gltf(tree_, path);
    ConfigNode intended = tree_;
    set_value(intended, path, parse_value(value, path, style), origin_);
    YamlDraft draft(text_, origin_, tree_);
    draft.become(intended);
    take(draft, intended, path);
}

void SceneText::remove(std::string_view path) {
    const NodeRoute route = require(*this, path);
    ConfigNode intended = tree_;
    const NodeRoute parent_route(route.begin(), route.end() - 1);
    ConfigNode& parent = node_in(intended, parent_route);
    const auto index = static_cast<std::ptrdiff_t>(route.back());
    if (parent.kind == ConfigNode::Kind::map)
        parent.entries.erase(parent.entries.begin() + index);
    else
        parent.items.erase(parent.items.begin() + index);
    YamlDraft draft(text_, origin_, tree_);
    if (is_written_there(tree_, parent_route))
        draft.remove(route);
    else
        draft.become(intended);
    take(draft, intended, path);
}

void SceneText::append(std::string_view list_path, std::string_view value, std::string_view like,
                       const NumberStyle& style) {
    const ConfigNode item = parse_value(value, list_path, style);
    const NodeRoute route = route_to(tree_, list_path);
    const ConfigNode* const list = route.empty() ? nullptr : &node_at(tree_, route);
    ConfigNode intended = tree_;
    YamlDraft draft(text_, origin_, tree_);
    if (list != nullptr && !list->items.empty()) {
        node_in(intended, route).items.push_back(item);
        std::size_t model = list->items.size() - 1;
        if (!like.empty()) {
            const NodeRoute like_route = require(*this, like);
            if (NodeRoute(like_route.begin(), like_route.end() - 1) != route)
                throw InputError(fmt::format("{}: {}: is no entry of {}", origin_, printable(like),
                                             printable(list_path)));
            model = like_route.back();
        }
        if (is_written_there(tree_, route))
            draft.append(route, item, model);
        else
            draft.become(intended);
        take(draft, intended, list_path);
        return;
    }
    ConfigNode one;
    one.kind = ConfigNode::Kind::sequence;
    one.items.push_back(item);
    set_value(intended, list_path, std::move(one), origin_);
    const bool is_block = text_[YamlLayout(text_).offset(tree_.position)] != '{';
    const bool is_empty = list == nullptr || list->alias.line == 0;
    if (parse_key_path(list_path).size() == 1 && is_block && is_empty && !item.entries.empty())
        draft.start_list(list_path, item);
    else
        draft.become(intended);
    take(draft, intended, list_path);
}

void SceneText::duplicate(std::string_view entry_path, std::string_view name) {
    const NodeRoute route = require(*this, entry_path);
    if (!is_in_list(tree_, route))
        throw InputError(fmt::format("{}: {}: is no entry of a list, so there cannot be two of it",
                                     origin_, printable(entry_path)));
    const NodeRoute list(route.begin(), route.end() - 1);
    ConfigNode copy = node_at(tree_, route);
    copy.alias = {};
    if (ConfigNode* const old = copy.find("name"))
        *old = text_node(name);
    else
        copy.entries.insert(copy.entries.begin(), {"name", {}, text_node(name)});
    ConfigNode intended = tree_;
    node_in(intended, list).items.push_back(copy);
    YamlDraft draft(text_, origin_, tree_);
    if (is_written_there(tree_, list))
        draft.append(list, copy, route.back(), true);
    else
        draft.become(intended);
    take(draft, intended, entry_path);
}

void SceneText::rename(std::string_view entry_path, std::string_view name) {
    require(*this, entry_path);
    set(std::string(entry_path) + ".name", quoted_if_needed(name, true));
}

}  // namespace uw
