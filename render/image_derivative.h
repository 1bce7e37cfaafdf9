#pragma once

#include <string>
#include <vector>

#include "render/renderer.h"

namespace uw {

/// The derivative of the scene's image, light scattered once, by one of
///
/// - "water.absorption", "water.scattering": the uniform water's coefficient in each band, its
///   phase function as it is [per 1/m]. Bands do not affect each other: each pixel has one
///   derivative per band.
/// - "water.particles.small", "water.particles.large": the concentration of the water's own
///   particles (particle_derivative) [per ppm].
/// - "concentration.NAME": a factor on all concentrations of a constituent of the volumes, at 1.
///
/// It is exact: what the integrator volume and the lighting of surfaces sum up is differentiated
/// term by term, at the same nodes. Row by row and pixel by pixel of `options.window`, a value per
/// band. `options.layers` and its transport are not used. Throws UsageError for other names, and
/// for images that have other light, or the mean over an exposure; it says why, and how to mend it.
std::vector<float> image_derivative(Renderer& renderer, const std::string& name,
                                    const RenderOptions& options);

}  // namespace uw
