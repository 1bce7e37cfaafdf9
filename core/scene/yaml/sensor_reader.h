#pragma once

#include "core/scene/scene_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `sensor` of a camera.
SensorDesc read_sensor(const ConfigValue& value, const SceneContext& context);

/// Checks the sensors of all cameras against the rest of the scene, and gives those without an
/// exposure time that of render.shutter. Throws InputError; adds warnings.
void complete_sensors(SceneDesc& scene);

}  // namespace uw
