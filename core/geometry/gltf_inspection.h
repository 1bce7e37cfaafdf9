#pragma once

#include <string>
#include <vector>

#include "core/geometry/gltf_document.h"
#include "core/geometry/mesh.h"

namespace uw {

/// Validates a glTF document before anything is read: nesting and node tree (a strict tree of
/// bounded depth), accessor and buffer sizes against the files' contents, types of vertex data,
/// required extensions, and that buffers are regular files. For gltf_*.cpp only. Returns the names
/// of features in the file that neither this program nor `use` takes (metallic, occlusion maps,
/// ...), without duplicates, sorted. Throws IoError, InputError, nlohmann's exceptions.
std::vector<std::string> inspect_gltf(const GltfDocument& document, const GltfUse& use);

}  // namespace uw
