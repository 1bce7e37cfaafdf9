#pragma once

#include <memory>
#include <optional>

#include "core/meshes/mesh.h"
#include "core/scene/geometry_desc.h"
#include "core/surfaces/scene_objects.h"

namespace uw {

/// Transforms a mesh to world space, in place: it may have tens of millions of vertices.
void place_mesh(TriangleMesh& mesh, const Affine& world_from_object);

/// Bounds of the referenced vertices; a file may have invalid vertices that no triangle uses.
Bounds bounds_of(const TriangleMesh& mesh);

/// What is traced of a mesh, as `desc` says; its ids are still to be set. `reflectance`: the one
/// given in the scene, if any.
std::shared_ptr<MeshObject> make_mesh_object(const GeometryDesc& desc, TriangleMesh mesh,
                                             const std::optional<Spectrum>& reflectance);

}  // namespace uw
