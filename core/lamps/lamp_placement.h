#pragma once

#include "core/base/affine.h"
#include "core/base/vec.h"

namespace uw {

/// The orientation of a lamp in the world, which places its profile.
struct LampPlacement {
    Affine world_from_frame;     // of the camera, or of another mount; rigid
    Vector3 direction{0, 0, 1};  // in which the lamp shines, in this frame, unit

    /// Perpendicular to the direction, in the frame, unit: from where angles about the direction
    /// are counted. The frame's x axis (y if the lamp shines along x), projected.
    Vector3 across() const {
        const Vector3 x(1, 0, 0), y(0, 1, 0);
        const Vector3& reference = glm::length(glm::cross(direction, x)) > 1e-6 ? x : y;
        return glm::normalize(reference - glm::dot(reference, direction) * direction);
    }
    /// The direction in which the lamp shines, world, unit.
    Vector3 axis() const { return glm::normalize(world_from_frame.apply_to_vector(direction)); }
};

}  // namespace uw
