#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/scene_arrays.h"
#include "core/scene/scene_desc.h"
#include "core/scene/variations/draw.h"
#include "core/scene/yaml/config_node.h"

namespace uw {

/// A scene with drawn values, as a tree and as what that describes.
struct VariedScene {
    ConfigNode tree;
    SceneDesc desc;
};

/// The scenes that a scene's section `variations` makes of it. Each is the scene with the values
/// drawn set as by --set, and has the same images.
class SceneVariations {
  public:
    /// Reads the scene file with its overrides. Throws as read_scene_tree and read_variations, and
    /// UsageError for an override of what is drawn.
    SceneVariations(const std::filesystem::path& file, const std::vector<std::string>& overrides);
    /// The same of a scene's tree. Throws as read_variations.
    SceneVariations(ConfigNode tree, std::filesystem::path file);

    /// What is drawn; none: the scene has no such section.
    const std::optional<VariationsDesc>& desc() const { return desc_; }

    /// The values of one variation, and its scene. Throws InputError where the scene with these
    /// values is none: the message says which variation and which value. Throws as load_scene.
    std::vector<DrawnValue> values(int variation) const { return draw(*desc_, variation); }
    SceneDesc scene(int variation) const { return varied(variation).desc; }
    /// The same with its tree, and of a scene that refers to `arrays`.
    VariedScene varied(int variation, const SceneArrays* arrays = nullptr) const;

  private:
    std::filesystem::path file_;
    ConfigNode tree_;
    std::optional<VariationsDesc> desc_;
};

}  // namespace uw
