#pragma once

#include "core/scene/water_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `water`; also sets the number of bands for the sections that follow.
WaterDesc read_water(const ConfigValue& value, SceneContext& context);

}  // namespace uw
