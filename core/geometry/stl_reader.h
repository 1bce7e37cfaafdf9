#pragma once

#include <filesystem>

#include "core/geometry/mesh.h"

namespace uw {

/// Reads the triangles of an STL file, text or binary, each with vertices of its own; degenerate
/// triangles and coordinates that are not finite are kept. Names of solids, the bytes that some
/// programs use for colours, and normals, which are those of the faces anyway, are not read. Throws
/// IoError; InputError for a file that is neither, is truncated, or has broken text
/// ("<file>:<line>:
/// ...").
TriangleMesh read_stl(const std::filesystem::path& file);

}  // namespace uw
