#include "edit/document/gltf_keys.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/yaml/scene_override.h"

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

}  // namespace

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

}  // namespace uw
