#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_desc.h"

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

/// The `water` of a scene without a file: the defaults, with `overrides` such as
/// "water.preset=jerlov-II" applied as read_scene does. Keys of other sections are errors; file
/// names are relative to the current folder. Throws as read_scene.
WaterDesc read_water_overrides(const std::vector<std::string>& overrides);

}  // namespace uw
