#pragma once

#include <vector>

#include "core/paths/water_segment.h"

namespace uw {

/// A camera ray in the water up to the first surface, prepared for many paths (PathTracer::begin).
/// Reused storage.
struct CameraSegment {
    WaterSegment water;
    Spectrum transmittance;  // up to the surface; not set without one
    /// Where the paths' first scattering lies: running sums of weights of the intervals between
    /// `distances`, in each of which it is uniform. Empty where the water scatters no light.
    std::vector<double> distances, cumulative;
    /// Rough means over the bands, which guide the paths.
    struct Light {
        double own = 0;      // the ray's radiance, without single scattering
        double ambient = 0;  // what a path may meet anywhere
    } light;
};

}  // namespace uw
