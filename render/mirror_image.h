#pragma once

#include "core/passes/pass.h"
#include "render/assembled_scene.h"

namespace uw {

/// Runs the passes of light on an image of the scene and, if its camera sees a reflecting water
/// surface, again on the mirror image, whose light is added.
void run_light_passes(const AssembledScene& scene, PassList& passes, Rendering& rendering);

}  // namespace uw
