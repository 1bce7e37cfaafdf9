#pragma once

#include "core/scene/camera_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `camera`, or one of `cameras` without its name.
CameraDesc read_camera(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
