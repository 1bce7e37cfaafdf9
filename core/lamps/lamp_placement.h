#pragma once

#include "core/base/affine.h"
#include "core/base/vec.h"

namespace uw {

/// How a lamp is turned in the world, which places its profile.
struct LampPlacement {
    Affine world_from_frame;     // of the camera, or of what else the lamp is mounted on; rigid
    Vector3 direction{0, 0, 1};  // that the lamp shines in, in this frame, unit

    /// The direction that the lamp shines in, world, unit.
    Vector3 axis() const { return glm::normalize(world_from_frame.apply_to_vector(direction)); }
};

}  // namespace uw
