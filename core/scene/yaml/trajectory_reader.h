#pragma once

#include "core/scene/trajectory_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// A `trajectory`: keyframes, or the file that has the poses, which is not read. `is_view`: of
/// something that looks, whose keyframes need a direction.
TrajectoryDesc read_trajectory(const ConfigValue& value, const SceneContext& context, bool is_view);

}  // namespace uw
