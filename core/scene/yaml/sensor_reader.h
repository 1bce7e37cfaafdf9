#pragma once

#include "core/scene/sensor_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `sensor` of a camera.
SensorDesc read_sensor(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
