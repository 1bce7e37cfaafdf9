#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/meshes/gltf/gltf_use.h"
#include "core/meshes/mesh.h"

namespace uw {

/// Reads the meshes of a glTF file's scene into one, node transforms applied; degenerate triangles
/// and invalid corners are kept. Points and lines are skipped. Adds one warning that lists the
/// unused features of the file. Throws IoError; InputError for damaged files, for unknown required
/// extensions, and for images that cannot be read.
TriangleMesh read_gltf(const std::filesystem::path& file, const GltfUse& use,
                       std::vector<std::string>& warnings);

}  // namespace uw
