#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/meshes/gltf/gltf_use.h"
#include "core/meshes/mesh.h"

namespace uw {

/// Reads the triangles of a glTF (.gltf, .glb), OBJ, PLY or STL file, as they lie in the file: no
/// axis or unit is converted. glTF brings its node hierarchy, materials (MeshMaterial), vertex
/// colours, normals and tangents; the others bring their normals at most (STL none, its normals are
/// those of the faces anyway), and one material of reflectance 0.5. Polygons are split into
/// triangles, those that are degenerate or have broken corners are dropped, and no normals are made
/// up.
///
/// Appends one line to `warnings` for everything dropped or ignored. Throws IoError if the file
/// cannot be opened, InputError if it is broken, of another kind, or has no triangles.
/// `use`: what else is taken from a glTF file, and so is not called ignored.
TriangleMesh read_mesh(const std::filesystem::path& file, std::vector<std::string>& warnings,
                       const GltfUse& use = {});

}  // namespace uw
