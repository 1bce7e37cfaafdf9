#pragma once

#include <optional>
#include <vector>

#include "core/frame/point_matcher.h"
#include "core/integrators/surface_light.h"

namespace uw {

/// What the rays of one pixel hit, before any lighting. Reused storage.
struct PixelView {
    double alpha = 0;        // fraction of the samples whose ray enters the water
    std::optional<Ray> ray;  // along which the pixel's water is integrated, if one enters it
    double x = 0, y = 0;     // image position of that ray
    /// The distances to which the pixel's water extends [m along `ray`, ascending; k_far without a
    /// surface], and the fraction of the samples for each. Empty without a ray.
    std::vector<double> distances, weights;

    std::vector<SurfaceSample> samples;  // those that hit a surface

    // Ground truth at the pixel's centre:
    bool has_hit = false;
    SurfaceHit hit;
    double depth_z = 0;  // camera-frame z of the hit
    double range = 0;    // from the camera's centre to the hit
    double path = 0;     // in water, from the outer glass surface to the hit
    PointMatches matches;
};

}  // namespace uw
