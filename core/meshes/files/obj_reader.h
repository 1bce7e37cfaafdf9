#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/meshes/mesh_file.h"

namespace uw {

/// Reads an OBJ file: polygons as triangles, normals, vertex colours (sRGB-encoded), the materials
/// of its libraries (read_obj_materials) and the texture coordinates they need. Each of its objects
/// is one of the result's. Corners past the last vertex are kept for drop_bad_triangles to count.
/// `is_pbr`: roughness and metallic are used. Throws IoError, InputError.
MeshFile read_obj(const std::filesystem::path& file, bool is_pbr,
                  std::vector<std::string>& warnings);

}  // namespace uw
