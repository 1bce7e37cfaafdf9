#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/meshes/mesh.h"

namespace uw {

/// Largest coordinate of a mesh in its file's units; products of three such numbers, which tracing
/// forms, are far from float's largest, 3e38.
inline constexpr double k_max_coordinate = 1e10;

/// How many triangles of a file were dropped, and why.
struct DroppedTriangles {
    std::uint64_t missing_corner = 0;  // an index past the last vertex
    std::uint64_t not_finite = 0;      // a corner is NaN, infinite or beyond k_max_coordinate
    std::uint64_t no_area = 0;

    /// One warning line per kind that occurred, each starting with `name`.
    void report(const std::string& name, std::vector<std::string>& warnings) const;
};

/// Removes the triangles that cannot be traced, in place and in order, and adds to `dropped`.
/// Normals that are not valid directions become zero ("flat").
void drop_bad_triangles(TriangleMesh& mesh, DroppedTriangles& dropped);

}  // namespace uw
