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
    /// Whether its content is part of SceneDesc::hash: a change shows without its date.
    bool is_hashed = false;
};

/// The files that glTF and OBJ files refer to, by that file: looked up once for many frames.
using MeshSideFiles = std::map<std::filesystem::path, std::vector<std::filesystem::path>>;

/// Every file that the scene of one image is read from, the scene file itself first: the one answer
/// to which files a scene depends on. A file that serves two purposes is listed twice. Missing or
/// broken files are not an error here. `known` is looked up and added to.
std::vector<InputFile> input_files(const SceneDesc& scene, MeshSideFiles& known);
std::vector<InputFile> input_files(const SceneDesc& scene);

}  // namespace uw
