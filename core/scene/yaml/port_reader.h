#pragma once

#include "core/scene/camera_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `port` of a camera.
PortDesc read_port(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
