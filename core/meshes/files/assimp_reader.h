#pragma once

#include <filesystem>

#include "core/meshes/mesh.h"

namespace uw {

/// Reads the triangles of an STL file with Assimp; degenerate triangles and invalid corners are
/// kept. The file's normals are those of the faces anyway, and not read. Throws InputError with
/// Assimp's message in one line.
TriangleMesh read_stl(const std::filesystem::path& file);

}  // namespace uw
