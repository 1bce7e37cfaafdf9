#pragma once

#include "core/scene/lamp_spectrum_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `spectrum` of a lamp, or the light that `white` of `render` shows white.
LampSpectrumDesc read_spectrum(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
