#pragma once

#include "core/motion/pose.h"
#include "core/scene/camera_desc.h"

namespace uw {

/// A camera's pose in the world, its quaternion with w >= 0.
inline Pose camera_pose(const CameraDesc& camera) {
    Pose pose = pose_of(camera.world_from_camera);
    Rotation& q = pose.rotation;
    if (q.w < 0) q = {-q.w, -q.x, -q.y, -q.z};
    return pose;
}

}  // namespace uw
