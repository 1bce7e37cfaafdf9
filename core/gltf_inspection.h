#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace uw {

/// What of a glTF file beside its meshes the scene takes.
struct GltfUse {
    bool camera = false, lamps = false;
};

/// Checks of a glTF file what Assimp takes on trust, before Assimp reads it: nesting and node tree
/// (a strict tree of bounded depth), accessor and buffer sizes against what the files hold, kinds
/// of vertex data, required extensions, texture sources, and that buffers are regular files.
/// Returns the names of what the file has and neither this program nor `use` takes (cameras,
/// lights, metallic, normal maps, ...), each once, sorted. Throws IoError, InputError.
std::vector<std::string> inspect_gltf(const std::filesystem::path& file, const GltfUse& use);

}  // namespace uw
