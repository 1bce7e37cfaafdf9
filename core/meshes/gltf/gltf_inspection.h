#pragma once

#include <string>
#include <vector>

#include "core/meshes/gltf/gltf_document.h"
#include "core/meshes/gltf/gltf_use.h"

namespace uw {

/// Checks what a glTF document claims, before anything is read: nesting and node tree (a strict
/// tree of bounded depth), accessor and buffer sizes against what the files hold, kinds of vertex
/// data, required extensions, and that buffers are regular files. For gltf_*.cpp only.
/// Returns the names of what the file has and neither this program nor `use` takes (cameras,
/// lights, metallic, skins, ...), each once, sorted. Throws IoError, InputError, nlohmann's
/// exceptions.
std::vector<std::string> inspect_gltf(const GltfDocument& document, const GltfUse& use);

}  // namespace uw
