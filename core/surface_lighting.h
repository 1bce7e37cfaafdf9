#pragma once

#include "core/integrator.h"
#include "core/lit_scene.h"
#include "core/optical_depth.h"

namespace uw {

/// Light of every lamp on the surface point `hit` of `ray` (physics section 5, `direct`), with one
/// exact shadow ray per lamp that the surface faces, and exact columns: a surface shows a single
/// one of them, where interpolation would be seen.
void light_surface(const LitScene& scene, const AttenuationTable& attenuation, const Ray& ray,
                   const SurfaceHit& hit, SurfaceLight& light);

}  // namespace uw
