#pragma once

#include "core/base/affine.h"
#include "core/motion/rotation.h"

namespace uw {

/// Where a body is: the rigid map from its space to another.
struct Pose {
    Point3 position;
    Rotation rotation;

    Affine affine() const { return {rotation.matrix(), from_origin(position)}; }

    friend bool operator==(const Pose&, const Pose&) = default;
};

/// The pose of a rigid map.
inline Pose pose_of(const Affine& rigid) {
    return {at_origin_plus(rigid.offset()), rotation_of(rigid.linear())};
}

/// Where a body is at a time [s].
struct TimedPose {
    double time = 0;
    Pose pose;

    friend bool operator==(const TimedPose&, const TimedPose&) = default;
};

}  // namespace uw
