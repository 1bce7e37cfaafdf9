#pragma once

#include <vector>

#include "core/scene/volume_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `volumes`. Their exposure time is not part of this section and stays 0.
std::vector<VolumeDesc> read_volumes(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
