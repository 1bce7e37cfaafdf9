#pragma once

#include "core/base/affine.h"
#include "core/base/vec.h"

namespace uw {

/// The orientation of a lamp in the world, which places its profile.
struct LampPlacement {
    Affine world_from_frame;     // of the camera, or of another mount; rigid
    Vector3 direction{0, 0, 1};  // in which the lamp shines, in this frame, unit

    /// The direction in which the lamp shines, world, unit.
    Vector3 axis() const { return glm::normalize(world_from_frame.apply_to_vector(direction)); }
};

}  // namespace uw
