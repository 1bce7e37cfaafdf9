#pragma once

#include <optional>
#include <vector>

#include "core/scene/scene_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `cameras` and `rig`; also sets the frames that lamps of a rig are fixed to.
std::vector<RigCameraDesc> read_cameras(const ConfigValue& value,
                                        const std::optional<ConfigValue>& rig,
                                        SceneContext& context);

}  // namespace uw
