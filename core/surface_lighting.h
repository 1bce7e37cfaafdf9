#pragma once

#include <span>

#include "core/lit_scene.h"
#include "core/optical_depth.h"
#include "core/surface_light.h"

namespace uw {

/// Light of every lamp on the surfaces of `samples` (physics section 5, `direct`), with one exact
/// shadow ray per lamp that a surface faces, and exact columns: a surface shows a single one of
/// them, where interpolation would be seen.
void light_surfaces(const LitScene& scene, const AttenuationTable& attenuation,
                    std::span<const SurfaceSample* const> samples, SurfaceLight& light);

}  // namespace uw
