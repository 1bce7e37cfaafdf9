#pragma once

#include <vector>

#include "core/paths/water_segment.h"

namespace uw {

/// A camera ray in the water up to the first surface, prepared for many paths (PathTracer::begin).
/// Reused storage.
struct CameraSegment {
    WaterSegment water;
    std::vector<double> transmittance;  // up to the surface, per band
    /// Where the paths' first scattering lies: running sums of weights of the intervals between
    /// `distances`, in each of which it is uniform. Empty where the water scatters no light.
    std::vector<double> distances, cumulative;
    double own_light = 0;  // roughly the ray's radiance, mean over the bands, for roulette
};

}  // namespace uw
