#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace uw {

/// What to take from a file beside its triangles.
struct AssimpOptions {
    bool normals = true;
    bool materials = false;  // base colours, textures, vertex colours: glTF
};

/// Reads a glTF, OBJ or STL file through Assimp; degenerate triangles and unusable corners are left
/// in. Coordinates are the file's, node transforms applied. Points and lines are skipped.
/// Throws InputError with Assimp's message in one line, or for textures that cannot be read.
TriangleMesh read_with_assimp(const std::filesystem::path& file, const AssimpOptions& options,
                              std::vector<std::string>& warnings);

}  // namespace uw
