#include "python/scene_object.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/text/flow_text.h"
#include "core/scene/variations/variations_reader.h"
#include "core/scene/yaml/scene_override.h"
#include "core/scene/yaml/yaml_document.h"
#include "render/scene_loading.h"
#include "render/scene_variations.h"

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

/// Its variations, of which `number` is one.
SceneVariations variations_of(const SceneObject& scene, int number) {
    if (number < 0)
        throw UsageError(
            fmt::format("variation: expected a whole number of 0 or more, found {}", number));
    SceneVariations variations(scene.tree(), scene.file());
    if (!variations.desc())
        throw UsageError(
            "variation: the scene has no variations; set them, such as scene[\"variations\"] = "
            "{\"keys\": {\"lamps[0].power\": {\"uniform\": [10, 30]}}}");
    return variations;
}

void refuse_taken(const std::string& section, const std::string& name, const SceneArrays& there) {
    if (there.grids.contains(name) || there.meshes.contains(name))
        throw UsageError(fmt::format(
            "{}.add: there is a '{}' already, added meanwhile; add one after the other, or give "
            "each a name",
            section, printable(name)));
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
    for (const auto& [name, grid] : arrays.grids) refuse_taken(section, name, arrays_);
    for (const auto& [name, mesh] : arrays.meshes) refuse_taken(section, name, arrays_);
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

SceneObject SceneObject::variation(int number) const {
    VariedScene varied = variations_of(*this, number).varied(number, &arrays_);
    SceneObject scene;
    scene.tree_ = std::move(varied.tree);
    scene.file_ = file_;
    scene.arrays_ = arrays_;
    scene.desc_ = std::make_shared<const SceneDesc>(std::move(varied.desc));
    return scene;
}

SceneObject::Changes SceneObject::variation_values(int number) const {
    Changes values;
    for (const DrawnValue& value : variations_of(*this, number).values(number))
        values.emplace_back(value.key, parse_yaml_value(value.text, value.override_text()));
    return values;
}

}  // namespace uw
