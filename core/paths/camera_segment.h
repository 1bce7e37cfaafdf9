#pragma once

#include "core/paths/water_segment.h"
#include "core/surfaces/surfaces.h"

namespace uw {

/// A camera ray in the water up to the first surface, prepared for many paths (PathTracer::begin).
/// Reused storage.
struct CameraSegment {
    WaterSegment water;
    /// Where the paths' first scattering lies: cumulative probability at `distances`, linear
    /// between them; empty where the water scatters no light.
    std::vector<double> distances, cumulative;
    double own_light = 0;  // rough mean over the bands of the ray's light, for roulette
};

}  // namespace uw
