#pragma once

#include "core/base/ray.h"

namespace uw {

/// A straight line in lattice space: p(t) = origin + t * direction.
struct LatticeLine {
    Point3 origin;
    Vector3 direction{0, 0, 1};
};

}  // namespace uw
