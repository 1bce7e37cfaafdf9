#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_arrays.h"
#include "core/scene/scene_desc.h"
#include "core/scene/yaml/config_node.h"

namespace uw {

/// Reads a scene with its overrides (core/scene/yaml/scene_reader.h), and the files of calibrations
/// and poses that it names, whose content is part of the scene's hash. Throws as read_scene,
/// read_calibration and load_trajectory do, and as read_variations: what the scene's variations
/// draw changes nothing here, but is checked.
SceneDesc load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// The same for a scene whose text is at hand (read_scene_text).
SceneDesc load_scene_text(std::string_view text, const std::filesystem::path& file);

/// The same for a scene's tree (scene_of_tree) whose variations have been read.
SceneDesc load_scene_tree(const ConfigNode& tree, const std::filesystem::path& file,
                          const SceneArrays* arrays = nullptr);

}  // namespace uw
