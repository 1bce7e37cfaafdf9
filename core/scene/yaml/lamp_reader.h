#pragma once

#include <vector>

#include "core/scene/lamp_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `lamps`.
std::vector<LampDesc> read_lamps(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
