#pragma once

#include <filesystem>
#include <vector>

#include "core/base/affine.h"

namespace uw {

/// file_from_node of everything that a glTF file counts as an object, in the order of
/// MeshFile::objects, where its animations have it at `time` [s]. Throws IoError, InputError.
std::vector<Affine> gltf_placements(const std::filesystem::path& file, double time);

}  // namespace uw
