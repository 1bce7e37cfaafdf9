#pragma once

#include <filesystem>
#include <vector>

#include "core/mesh.h"

struct aiScene;

namespace uw {

/// A glTF material as Assimp read it, and which set of texture coordinates its texture uses.
struct AssimpMaterial {
    MeshMaterial material;
    unsigned uv_set = 0;
};

/// One per material of `scene` in its order; textures are decoded once and shared. The last is
/// Assimp's stand-in for meshes without a material, a neutral 0.5. `file` is the glTF file.
/// Throws InputError, IoError for textures that cannot be read.
std::vector<AssimpMaterial> read_assimp_materials(const aiScene& scene,
                                                  const std::filesystem::path& file);

}  // namespace uw
