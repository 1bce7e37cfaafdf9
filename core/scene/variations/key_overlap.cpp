#include "core/scene/variations/key_overlap.h"

#include <algorithm>

#include "core/scene/yaml/scene_override.h"

namespace uw {
namespace {

/// The steps of a path, names of list entries replaced by their indices as far as the scene goes.
std::vector<KeyStep> resolved(const ConfigNode& scene, const std::string& key) {
    std::vector<KeyStep> steps = parse_key_path(key);
    const ConfigNode* node = &scene;
    std::string path;
    for (std::size_t i = 0; i < steps.size() && node != nullptr; ++i) {
        KeyStep& step = steps[i];
        if (node->kind == ConfigNode::Kind::sequence) {
            for (std::size_t item = 0; item < node->items.size() && !step.index; ++item)
                if (entry_name(*node, item, path) == step.key) step = {"", item};
            const bool is_there = step.index && *step.index < node->items.size();
            node = is_there ? &node->items[*step.index] : nullptr;
        } else {
            node = step.index ? nullptr : node->find(step.key);
        }
        path += (path.empty() || step.index ? "" : ".") + step.text();
    }
    return steps;
}

bool begins_with(const std::vector<KeyStep>& part, const std::vector<KeyStep>& whole) {
    return part.size() >= whole.size() && std::equal(whole.begin(), whole.end(), part.begin());
}

}  // namespace

bool is_part_of(const ConfigNode& scene, const std::string& part, const std::string& whole) {
    return begins_with(resolved(scene, part), resolved(scene, whole));
}

std::optional<std::pair<std::string, std::string>> overlap(const ConfigNode& scene,
                                                           const std::vector<std::string>& keys) {
    std::vector<std::vector<KeyStep>> paths;
    for (const std::string& key : keys) paths.push_back(resolved(scene, key));
    for (std::size_t i = 0; i < keys.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (begins_with(paths[i], paths[j]) || begins_with(paths[j], paths[i]))
                return std::pair(keys[j], keys[i]);
    return std::nullopt;
}

}  // namespace uw
