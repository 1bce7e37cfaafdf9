#pragma once

#include "core/scene/water_surface_desc.h"

namespace uw {

/// What makes a lamp a sun: its light is parallel, or comes from a disc in the sky, and enters the
/// water through its surface.
struct SunDesc {
    double angle = 0;          ///< angular diameter of the disc, in the water [degrees], 0..90
    int samples = 32;          ///< how many directions stand for it unless the angle is 0, 1..1024
    WaterSurfaceDesc surface;  ///< the scene's (WaterDesc::surface)

    friend bool operator==(const SunDesc&, const SunDesc&) = default;
};

}  // namespace uw
