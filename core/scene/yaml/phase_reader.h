#pragma once

#include "core/scene/phase_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `phase` of the water's scattering or of a grid.
PhaseDesc read_phase(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
