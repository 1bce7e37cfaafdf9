#pragma once

#include "core/base/spectrum.h"
#include "core/paths/path_terms.h"

namespace uw {

/// What a path from the camera has done up to its current segment.
struct PathState {
    Spectrum throughput;  // radiance at the camera per radiance that arrives along the segment
    int scatterings = 0, reflections = 0;
    bool from_water = false;  // where it first turned, seen from the camera
    double distance = 0;      // and how far along the camera ray [m]
    double branches = 1;      // into how many it has split

    /// A term of light that arrives along the segment.
    PathTerm term(std::size_t lamp, std::span<const double> radiance) const {
        return {lamp, scatterings, reflections, from_water, distance, radiance};
    }
};

}  // namespace uw
