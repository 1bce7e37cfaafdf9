#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/meshes/gltf/gltf_use.h"
#include "core/meshes/mesh.h"

namespace uw {

/// Reads the triangles of a glTF (.gltf, .glb), OBJ, PLY or STL file, in the file's coordinates: no
/// axis or unit is converted. For glTF, the node hierarchy, materials (MeshMaterial), vertex
/// colours, normals and tangents are read; for the others at most normals (not for STL, whose
/// normals are those of the faces anyway), with one material of reflectance 0.5. Polygons are split
/// into triangles, degenerate triangles and those with invalid corners are dropped, and no normals
/// are generated.
///
/// Appends one line to `warnings` for everything dropped or ignored. Throws IoError if the file
/// cannot be opened, InputError if it is damaged, of another format, or has no triangles. `use`:
/// what else is taken from a glTF file, and is therefore not reported as ignored.
TriangleMesh read_mesh(const std::filesystem::path& file, std::vector<std::string>& warnings,
                       const GltfUse& use = {});

}  // namespace uw
