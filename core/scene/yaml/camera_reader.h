#pragma once

#include <optional>
#include <vector>

#include "core/scene/camera_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `camera`, or one of `cameras` without its name.
CameraDesc read_camera(const ConfigValue& value, const SceneContext& context);

/// `cameras` and `rig`; also sets the frames that lamps of a rig are fixed to, and how it moves.
std::vector<RigCameraDesc> read_cameras(const ConfigValue& value,
                                        const std::optional<ConfigValue>& rig,
                                        SceneContext& context);

}  // namespace uw
