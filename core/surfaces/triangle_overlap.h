#pragma once

#include <cstdint>
#include <optional>

#include "core/base/ray.h"
#include "core/surfaces/scene_objects.h"

namespace uw {

/// Triangles that lie over one another by the thousands, such as those of copies in nearly the same
/// place: no structure tells them apart, and each ray there meets all of them.
struct TriangleOverlap {
    double triangles = 0;         // how many there are, about
    Point3 where;                 // [m]
    std::uint32_t object_id = 0;  // of one of them
};

/// Where more surface than covers a cube's face 4096 times lies in one cube, of triangles of its
/// size. Looks at 65536 triangles of all at most, whatever their number.
std::optional<TriangleOverlap> find_overlap(const SceneObjects& objects);

}  // namespace uw
