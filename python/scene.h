#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene_context.h"
#include "core/scene/scene_desc.h"
#include "core/scene/yaml_document.h"
#include "python/arguments.h"

namespace uw {

/// A scene that is changed value by value. It is valid at all times: a change that no scene file
/// could have throws, as load_scene does, and leaves everything as it was.
class SceneObject {
  public:
    /// `file` is where the scene belongs: names of files in it are relative to its folder.
    SceneObject(ConfigNode tree, std::filesystem::path file, SceneArrays arrays = {});

    const ConfigNode& tree() const { return tree_; }
    const std::filesystem::path& file() const { return file_; }
    const SceneArrays& arrays() const { return arrays_; }
    /// What it describes, which stays as it is when the scene changes.
    const std::shared_ptr<const SceneDesc>& desc() const { return desc_; }

    /// Values by their paths, as --set has them (set_value). They are set together: only what comes
    /// of all of them is checked.
    using Changes = std::vector<std::pair<std::string, ConfigNode>>;
    void set(const Changes& changes);
    /// Removes the value at a path (remove_value); false if there is none.
    bool remove(const std::string& path);
    /// Adds an entry to the list of a section ("volumes"), and what is in memory for it.
    /// UsageError if something in memory has its name already.
    void append(const std::string& section, ConfigNode entry, SceneArrays arrays);

    /// Puts others in the place of a grid or a mesh in memory.
    void set_grid(const std::string& name, std::shared_ptr<const LoadedGrid> grid);
    void set_mesh(const std::string& name, std::shared_ptr<const TriangleMesh> mesh);

    /// The scene with the values of one of its variations, counted from 0 (SceneVariations).
    /// UsageError if there is none.
    SceneObject variation(int number) const;
    /// Those values, by their paths.
    Changes variation_values(int number) const;

  private:
    SceneObject() = default;
    void replace(ConfigNode tree, SceneArrays arrays);

    ConfigNode tree_;
    std::filesystem::path file_;
    SceneArrays arrays_;
    std::shared_ptr<const SceneDesc> desc_;
};

/// Makes `origin` the place that messages name for a value and all in it.
void set_origin(ConfigNode& value, const std::string& origin);

}  // namespace uw

UWVDB_BOUND_CLASS(uw::SceneObject);
