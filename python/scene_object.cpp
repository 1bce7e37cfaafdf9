#include "python/scene_object.h"

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/scene/text/flow_text.h"
#include "core/scene/variations/variations_reader.h"
#include "core/scene/yaml/scene_override.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

constexpr std::size_t k_longest_origin = 80;  // as of --set

void set_origin(ConfigNode& value, const std::shared_ptr<const std::string>& origin) {
    value.position = {origin, 0, 0};
    for (ConfigNode& item : value.items) set_origin(item, origin);
    for (ConfigNode::Entry& entry : value.entries) {
        entry.position = {origin, 0, 0};
        set_origin(entry.value, origin);
    }
}

}  // namespace

void set_origin(ConfigNode& value, const std::string& origin) {
    set_origin(value, std::make_shared<const std::string>(origin));
}

SceneObject::SceneObject(ConfigNode tree, std::filesystem::path file, SceneArrays arrays)
    : file_(std::move(file)) {
    replace(std::move(tree), std::move(arrays));
}

void SceneObject::replace(ConfigNode tree, SceneArrays arrays) {
    read_variations(tree, file_);
    auto desc = std::make_shared<const SceneDesc>(load_scene_tree(tree, file_, &arrays));
    tree_ = std::move(tree);
    arrays_ = std::move(arrays);
    desc_ = std::move(desc);
}

void SceneObject::set(const Changes& changes) {
    ConfigNode tree = tree_;
    for (const auto& [path, value] : changes) {
        const std::string origin =
            printable(fmt::format("{} = {}", path, flow_text(value)), k_longest_origin);
        ConfigNode placed = value;
        set_origin(placed, origin);
        set_value(tree, path, std::move(placed), origin);
    }
    replace(std::move(tree), arrays_);
}

bool SceneObject::remove(const std::string& path) {
    ConfigNode tree = tree_;
    if (!remove_value(tree, path)) return false;
    replace(std::move(tree), arrays_);
    return true;
}

void SceneObject::append(const std::string& section, ConfigNode entry, SceneArrays arrays) {
    ConfigNode tree = tree_;
    ConfigNode* list = tree.find(section);
    if (list == nullptr) {
        tree.entries.push_back({section, entry.position, {}});
        list = &tree.entries.back().value;
        list->position = entry.position;
    }
    list->kind = ConfigNode::Kind::sequence;
    list->items.push_back(std::move(entry));
    SceneArrays all = arrays_;
    for (auto& grid : arrays.grids) all.grids.insert(std::move(grid));
    for (auto& mesh : arrays.meshes) all.meshes.insert(std::move(mesh));
    replace(std::move(tree), std::move(all));
}

}  // namespace uw
