#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/meshes/gltf/gltf_use.h"
#include "core/meshes/mesh_file.h"

namespace uw {

/// Reads the meshes that a glTF file's scene shows, and names its nodes and materials; degenerate
/// triangles and invalid corners are kept. A mesh that several nodes show is shared unless it is
/// small (MeshFile::shared). Points and lines are skipped. Adds one warning that lists the unused
/// features of the file, and one that names what would move. Throws IoError; InputError for damaged
/// files, for unknown required extensions, and for images that cannot be read.
MeshFile read_gltf(const std::filesystem::path& file, const GltfUse& use,
                   std::vector<std::string>& warnings);

}  // namespace uw
