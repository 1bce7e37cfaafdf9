#pragma once

#include <functional>
#include <span>

#include "core/integrator.h"
#include "core/lit_scene.h"
#include "core/optical_depth.h"

namespace uw {

/// Fills the column concentrations from lamp `lamp` to the surface point, one per constituent.
using LampColumn = std::function<void(std::size_t lamp, std::span<double> column)>;

/// Light of every lamp on the surface point `hit` of `ray` (physics section 5, `direct`), with one
/// exact shadow ray per lamp that the surface faces; the lamps' columns come from `lamp_column`.
void light_surface(const LitScene& scene, const AttenuationTable& attenuation, const Ray& ray,
                   const SurfaceHit& hit, const LampColumn& lamp_column, SurfaceLight& light);

}  // namespace uw
