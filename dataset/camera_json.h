#pragma once

#include "core/base/json.h"
#include "core/scene/camera_desc.h"

namespace uw {

/// A port's shape and indices, in the words of scene files.
Json port_json(const PortDesc& port);

/// A camera's resolution, intrinsics, distortion, port and pose, at full precision: matrices and
/// quaternions (w first) are world_from_camera with x right, y down, z forward.
Json camera_json(const CameraDesc& camera);
/// Throws Json::exception for anything else.
CameraDesc camera_from_json(const Json& json);

}  // namespace uw
