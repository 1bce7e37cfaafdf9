#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/geometry/mesh.h"

namespace uw {

/// The materials of an OBJ file: those with these names in its material libraries. Libraries that
/// are missing or lie outside the OBJ's folder, materials that no library has, textures that are
/// missing or not PNG or JPEG, and statements that cannot be used each add one line to `warnings`;
/// without anything else, a material has reflectance 0.5. `is_pbr`: roughness and metallic are
/// used. Throws InputError for broken libraries and damaged textures, IoError.
std::vector<MeshMaterial> read_obj_materials(const std::filesystem::path& obj_file,
                                             const std::vector<std::string>& libraries,
                                             const std::vector<std::string>& names, bool is_pbr,
                                             std::vector<std::string>& warnings);

/// The material libraries and textures that an OBJ file leads to. None for a file that cannot be
/// read; the actual reader reports what is wrong.
std::vector<std::filesystem::path> files_named_by_obj(const std::filesystem::path& obj_file);

/// Reads an OBJ file: polygons as triangles, normals, vertex colours (sRGB-encoded), the materials
/// of its libraries (read_obj_materials) and the texture coordinates they need. Each of its objects
/// is one of the result's. Corners past the last vertex are kept for drop_bad_triangles to count.
/// `is_pbr`: roughness and metallic are used. Throws IoError, InputError.
MeshFile read_obj(const std::filesystem::path& file, bool is_pbr,
                  std::vector<std::string>& warnings);

}  // namespace uw
