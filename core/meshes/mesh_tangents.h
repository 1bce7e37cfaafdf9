#pragma once

#include <cstdint>

#include "core/base/vec.h"
#include "core/meshes/mesh.h"

namespace uw {

/// Makes the tangents that a mesh with normal maps lacks (all zero), from the coordinates of each
/// triangle's normal map: at every vertex the mean over the triangles that meet there, weighted by
/// their angles and laid into the plane of the normal, as MikkTSpace does, but for vertices that
/// mirrored halves of a texture share, which get the side of most. Triangles without vertex
/// normals or with broken coordinates keep zeros. Precondition: corners are in range.
void compute_tangents(TriangleMesh& mesh);

/// Where the u of a triangle's normal map grows and where its v shrinks [any length]; false if the
/// coordinates are degenerate. `use` is the map.
struct UvAxes {
    Vector3 u_axis{0.0}, up_axis{0.0};
};
bool uv_axes(const TriangleMesh& mesh, const std::uint32_t* corners, const TextureUse& use,
             UvAxes& axes);

}  // namespace uw
