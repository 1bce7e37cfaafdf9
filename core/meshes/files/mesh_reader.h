#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/meshes/gltf/gltf_use.h"
#include "core/meshes/mesh_file.h"

namespace uw {

/// Reads what a glTF (.gltf, .glb), OBJ, PLY or STL file shows, in the file's coordinates: no axis
/// or unit is converted. For glTF, the node hierarchy, materials (MeshMaterial), vertex colours,
/// normals and tangents are read; for OBJ, materials, vertex colours and normals; for PLY, vertex
/// colours and normals. What has no material has reflectance 0.5, or its vertex colours. Polygons
/// are split into triangles, degenerate triangles and those with invalid corners are dropped, and
/// no normals are generated.
///
/// Appends one line to `warnings` for everything dropped or ignored. Throws IoError if the file
/// cannot be opened, InputError if it is damaged, of another format, or has no triangles, unless
/// `use` takes something else from it. `use`: what is taken besides diffuse meshes, and is
/// therefore not reported as ignored.
MeshFile read_mesh(const std::filesystem::path& file, std::vector<std::string>& warnings,
                   const GltfUse& use = {});

/// The other files that read_mesh reads for a mesh file: buffers, textures and material libraries.
/// None for a file that cannot be read.
std::vector<std::filesystem::path> files_named_by_mesh(const std::filesystem::path& file);

}  // namespace uw
