#pragma once

#include "core/light/surface_lighting.h"
#include "core/light/volume_integrator.h"
#include "core/passes/pixel_renderer.h"
#include "core/paths/path_segment.h"

namespace uw {

// The light of a pixel term by term, each with its way.

/// Adds what a surface sends straight to the camera: what it emits, and what it reflects of each
/// emitter's light, `light` at the place `in_light`. `leaving`: its radiance at the surface itself
/// is added [W m^-2 sr^-1].
void add_direct_light(const LitScene& scene, const SurfaceSample& surface,
                      const SurfaceLight& light, std::size_t in_light, ContributionSink& terms,
                      Spectrum& leaving);

/// Adds all that PixelRenderer sums up for a pixel, light scattered or reflected once: the samples
/// of `view`, whose light is `light`, lamps in view, and every node of `water` on its ray.
void add_quadrature_terms(const PixelRenderer& pixels, const VolumeIntegrator& water,
                          const PixelView& view, const SurfaceLight& light,
                          ContributionSink& terms);

}  // namespace uw
