#pragma once

#include "core/light/surface_lighting.h"
#include "core/light/volume_integrator.h"
#include "core/passes/pixel_renderer.h"
#include "core/paths/path_segment.h"

namespace uw {

// The light of a pixel, contribution by contribution, each with its path.

/// Adds the direct light of a surface: what it emits, and what it reflects of each emitter's light,
/// which is number `light_index` of `light`. Adds the radiance at the surface itself to `leaving`
/// [W m^-2 sr^-1].
void add_direct_light(const LitScene& scene, const SurfaceSample& surface,
                      const SurfaceLight& light, std::size_t light_index, ContributionSink& sink,
                      Spectrum& leaving);

/// Adds all single scattering of a pixel, which PixelRenderer sums: the samples of `view`, whose
/// light is `light`, the lamps in view, and every quadrature node of `water` on the pixel's ray.
void add_quadrature_terms(const PixelRenderer& pixels, const VolumeIntegrator& water,
                          const PixelView& view, const SurfaceLight& light, ContributionSink& sink);

}  // namespace uw
