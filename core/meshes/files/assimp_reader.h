#pragma once

#include <filesystem>

#include "core/meshes/mesh.h"

namespace uw {

/// Reads the triangles of an OBJ or STL file with Assimp, and its normals if `normals`; degenerate
/// triangles and invalid corners are kept. Coordinates are the file's. Points and lines are
/// skipped. Throws InputError with Assimp's message in one line.
TriangleMesh read_with_assimp(const std::filesystem::path& file, bool normals);

}  // namespace uw
