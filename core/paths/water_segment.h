#pragma once

#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/integrators/lit_scene.h"
#include "core/optics/concentration_field.h"
#include "core/optics/optical_depth.h"
#include "core/surfaces/surfaces.h"

namespace uw {

/// A straight part of a light path through the water, from a point to the first surface.
struct WaterSegment {
    Ray ray;
    double length = 0;  // [m]; k_far without a surface
    bool has_hit = false;
    SurfaceHit hit;                // at its end
    ConcentrationProfile profile;  // empty, without knots, where all of the water is uniform
};

}  // namespace uw
