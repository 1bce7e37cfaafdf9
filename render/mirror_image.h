#pragma once

#include "core/passes/pass.h"
#include "render/assembled_scene.h"

namespace uw {

/// Runs the passes of light on an image of the scene, and again on what its camera sees in the
/// water's surface, where that reflects: the light of that image is added.
void run_light_passes(const AssembledScene& scene, PassList& passes, Rendering& rendering);

}  // namespace uw
