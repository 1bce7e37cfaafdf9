#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace uw {

/// Checks of a glTF file what Assimp takes on trust, before Assimp reads it: nesting and node tree
/// (a strict tree of bounded depth), accessor and buffer sizes against what the files hold, kinds
/// of vertex data, required extensions, texture sources, and that buffers are regular files.
/// Returns the names of what the file has and this program ignores (cameras, lights, metallic,
/// normal maps, ...), each once, sorted. Throws IoError, InputError.
std::vector<std::string> inspect_gltf(const std::filesystem::path& file);

}  // namespace uw
