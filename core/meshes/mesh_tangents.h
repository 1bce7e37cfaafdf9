#pragma once

#include <cstdint>

#include "core/base/vec.h"
#include "core/meshes/mesh.h"

namespace uw {

/// Computes the tangents that a mesh with normal maps lacks (all zero) from the texture coordinates
/// of each triangle's normal map: at every vertex the mean over its triangles, weighted by their
/// angles and projected into the plane perpendicular to the normal, as MikkTSpace does, except that
/// vertices shared by mirrored halves of a texture take the side of the majority. Triangles without
/// vertex normals or with invalid coordinates keep zeros. Precondition: corners are in range.
void compute_tangents(TriangleMesh& mesh);

/// The directions in which the u of a triangle's normal map increases and its v decreases [any
/// length]; false if the coordinates are degenerate. `use` is the map.
struct UvAxes {
    Vector3 u_axis{0.0}, up_axis{0.0};
};
bool uv_axes(const TriangleMesh& mesh, const std::uint32_t* corners, const TextureUse& use,
             UvAxes& axes);

}  // namespace uw
