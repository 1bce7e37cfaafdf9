#pragma once

#include <string>

#include "core/meshes/gltf/gltf_document.h"

namespace uw {

/// What of a file would move but stands still here, as a warning without the file's name: nodes
/// that animations name and nodes with a skin. Empty if there are none. For gltf_*.cpp only.
std::string unused_motion_of(const GltfDocument& document);

}  // namespace uw
