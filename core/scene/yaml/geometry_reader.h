#pragma once

#include <vector>

#include "core/scene/geometry_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `geometry`.
std::vector<GeometryDesc> read_geometry(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
