#pragma once

#include "cli/render/render_arguments.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// Changes what the arguments say about how a scene is rendered: quality, integrator, samples and
/// size. Throws UsageError.
void apply_arguments(const RenderArguments& arguments, SceneDesc& scene);

}  // namespace uw
