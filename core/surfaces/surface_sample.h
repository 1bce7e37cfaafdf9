#pragma once

#include "core/base/ray.h"
#include "core/surfaces/surfaces.h"

namespace uw {

/// A surface point hit by a camera ray.
struct SurfaceSample {
    Ray ray;
    SurfaceHit hit;
    double x = 0, y = 0;  // image position of the ray [pixels]
};

}  // namespace uw
