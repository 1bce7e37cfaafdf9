#pragma once

#include "core/base/vec.h"

namespace uw {

/// The surface of the water: a plane, through which sunlight enters.
struct WaterSurfaceDesc {
    Point3 point;             ///< on it, world [m]
    Vector3 normal{0, 1, 0};  ///< out of the water, world, unit

    friend bool operator==(const WaterSurfaceDesc&, const WaterSurfaceDesc&) = default;
};

}  // namespace uw
