#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_arrays.h"
#include "core/scene/scene_desc.h"
#include "core/scene/yaml/config_node.h"

namespace uw {

/// Reads a scene file (version 1, docs/scene-file.md) and checks all of it.
/// `overrides` are "key.path=value" as given to --set, applied in order before checking.
/// Throws InputError with one line "file:line:column: key path: what; mend", IoError if the file
/// cannot be read, UsageError for an override that is not of that form.
SceneDesc read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// The same for a scene whose text is at hand, such as one that is being edited: `file` is where it
/// belongs, for messages and the names of files, and is not read.
SceneDesc read_scene_text(std::string_view text, const std::filesystem::path& file,
                          const std::vector<std::string>& overrides = {});

/// The section of a scene that says how others are made of it. It is no part of the scene itself:
/// it is passed over here, and read by core/scene/variations.
inline constexpr std::string_view k_variations_key = "variations";

/// In two steps: the tree of a scene with its overrides, and the scene that it describes, which may
/// refer to what is in `arrays`. Both throw as read_scene.
ConfigNode read_scene_tree(const std::filesystem::path& file,
                           const std::vector<std::string>& overrides);
ConfigNode scene_tree(std::string_view text, const std::filesystem::path& file,
                      const std::vector<std::string>& overrides = {});
SceneDesc scene_of_tree(const ConfigNode& root, const std::filesystem::path& file,
                        const SceneArrays* arrays = nullptr);

/// The `water` of a scene without a file: the defaults, with `overrides` such as
/// "water.preset=jerlov-II" applied as read_scene does. Keys of other sections are errors; file
/// names are relative to the current folder. Throws as read_scene.
WaterDesc read_water_overrides(const std::vector<std::string>& overrides);

/// The same of a tree whose only section is `water`.
WaterDesc water_of_tree(const ConfigNode& root);

}  // namespace uw
