#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/meshes/gltf/gltf_use.h"
#include "core/meshes/mesh.h"

namespace uw {

/// Reads the meshes of a glTF file's scene into one, node transforms applied; degenerate triangles
/// and unusable corners are left in. Points and lines are skipped. Adds one warning that lists what
/// of the file is not used. Throws IoError; InputError for what is broken, for required extensions
/// that are not known, and for pictures that cannot be read.
TriangleMesh read_gltf(const std::filesystem::path& file, const GltfUse& use,
                       std::vector<std::string>& warnings);

}  // namespace uw
