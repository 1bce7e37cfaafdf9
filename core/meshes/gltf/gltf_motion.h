#pragma once

#include <string>

#include "core/meshes/gltf/gltf_document.h"
#include "core/meshes/gltf/gltf_use.h"

namespace uw {

/// What of a file would move but stands still here, as a warning without the file's name: what
/// animations name, unless they move it at the time of `use`, and nodes with a skin. Empty if there
/// are none. For gltf_*.cpp only.
std::string unused_motion_of(const GltfDocument& document, const GltfUse& use);

}  // namespace uw
