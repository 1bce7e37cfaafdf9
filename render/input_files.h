#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/scene/scene_desc.h"

namespace uw {

/// A file that a scene is read from.
struct InputFile {
    std::filesystem::path file;
    std::string what;  // for messages: "a volume of the scene"
    /// Whether its content is part of SceneDesc::hash: no date is needed to tell that it changed.
    bool is_hashed = false;
};

/// What glTF files name beside themselves, by their own name: found out once for many frames.
using GltfSideFiles = std::map<std::filesystem::path, std::vector<std::filesystem::path>>;

/// Every file that the scene of one image is read from, the scene file itself first: whoever asks
/// which files a scene depends on asks here. A file that serves two purposes stands here twice.
/// Files that are missing or broken are no error here. `known` is looked up and added to.
std::vector<InputFile> input_files(const SceneDesc& scene, GltfSideFiles& known);
std::vector<InputFile> input_files(const SceneDesc& scene);

}  // namespace uw
