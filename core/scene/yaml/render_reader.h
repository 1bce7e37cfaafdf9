#pragma once

#include "core/scene/render_desc.h"
#include "core/scene/yaml/config_value.h"
#include "core/scene/yaml/scene_context.h"

namespace uw {

/// `render`.
RenderDesc read_render(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
