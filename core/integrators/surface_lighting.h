#pragma once

#include <span>

#include "core/integrators/lit_scene.h"
#include "core/integrators/surface_columns.h"
#include "core/integrators/surface_light.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// Light of every lamp on the surfaces of `samples` (physics section 5, `direct`), with one exact
/// shadow ray per lamp that a surface faces, and columns mixed as `mixing` says. A surface shows a
/// single one of them, where interpolation would be seen: those of the deep shadow maps alone are
/// not enough.
void light_surfaces(const LitScene& scene, const AttenuationTable& attenuation,
                    std::span<const SurfaceSample* const> samples, SurfaceLight& light,
                    const ColumnMixing& mixing = {});

}  // namespace uw
