#pragma once

#include "core/scene/lamp_spectrum_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `spectrum` of a lamp, or `white` of `render`, the light displayed as white.
LampSpectrumDesc read_spectrum(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
