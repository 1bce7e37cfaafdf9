#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/meshes/mesh.h"

namespace uw {

/// Reads a PLY file (ascii, binary of either byte order): positions, normals if all three
/// components are present, vertex colours (sRGB-encoded, of 8 or 16 bits or floats of 0..1), faces.
/// Other colours are skipped with a warning; alpha, texture coordinates, and elements other than
/// vertices and faces, without one. Corners past the last vertex are kept for
/// drop_bad_triangles to count. Throws IoError, InputError (also for a header that promises more
/// than the file holds).
TriangleMesh read_ply(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace uw
