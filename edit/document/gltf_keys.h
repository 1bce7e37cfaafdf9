#pragma once

#include <string_view>

#include "core/scene/yaml/config_node.h"

namespace uw {

/// Throws InputError, one line with the reason, if the scene takes the lamp, the pose or the
/// intrinsics at `path` from a glTF file: they are not in the scene file, and cannot be changed
/// there. `root` is a scene's tree.
void check_not_of_gltf(const ConfigNode& root, std::string_view path);

}  // namespace uw
