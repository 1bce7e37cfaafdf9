#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_desc.h"

namespace uw {

/// Reads a scene with its overrides (core/scene/yaml/scene_reader.h), and the files of calibrations
/// and poses that it names, whose content is part of the scene's hash. Throws as read_scene,
/// read_calibration and load_trajectory do.
SceneDesc load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// The same for a scene whose text is at hand (read_scene_text).
SceneDesc load_scene_text(std::string_view text, const std::filesystem::path& file);

}  // namespace uw
