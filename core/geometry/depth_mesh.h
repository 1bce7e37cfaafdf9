#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/vector_math.h"

namespace uw {

/// How an image of depths becomes a surface.
struct DepthMeshOptions {
    /// Two neighbouring pixels belong to different surfaces where the larger depth is more than
    /// this fraction beyond the smaller, and no plane through the pixel before them explains it.
    double edge = 0.03;
    /// Normals are those of planes through the pixels within this distance, in x and in y; 0: there
    /// are none, and each triangle has its own.
    int normal_radius = 3;
};

/// The surface that an image of depths shows: every pixel with a depth is covered to its borders,
/// and no triangle reaches across an occlusion edge or into a hole.
struct DepthMesh {
    std::vector<float> positions;          // x, y, z per vertex
    std::vector<float> normals;            // likewise, towards the camera, unit; may be empty
    std::vector<float> uvs;                // u, v in the image, (0, 0) its top left corner
    std::vector<std::uint32_t> triangles;  // counterclockwise as the camera sees them
    std::uint64_t edges = 0;               // pairs of neighbouring pixels that were cut apart
};

/// Makes the surface of an image of 1/z, z the depth along the optical axis [1/m], 0 where there is
/// none. `ray`: for an image position [pixels] the direction, of length 1 along the axis, in any
/// axes, which are then those of the result; none outside of the lens. Precondition: pixels with a
/// depth have a ray.
///
/// Vertices stand beside the pixels' centres, where depths are exact but for a hundredth of the
/// surface's curvature over a pixel. Where neighbours are cut apart or
/// missing, a pixel goes on to its border along its own slope. All interpolation is of 1/z, in
/// which planes are linear over the image.
DepthMesh mesh_of_depth(const Grid2D<double>& inverse_depth,
                        const std::function<std::optional<Vector3>(double x, double y)>& ray,
                        const DepthMeshOptions& options = {});

}  // namespace uw
