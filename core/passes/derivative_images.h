#pragma once

#include <cstddef>
#include <vector>

#include "core/base/progress.h"
#include "core/image/film.h"
#include "core/light/volume_integrator.h"
#include "core/passes/pixel_renderer.h"
#include "core/paths/path_scores.h"

namespace uw {

/// The derivatives of an image by numbers of its scene, [change][pixel of the window][band]: light
/// as the image's `total` holds it, per unit of the number. Pixels do not depend on the window, nor
/// results on the number of threads. Throws InputError if there is not enough memory, and
/// Interrupted.
///
/// Of light scattered or reflected once: the same sums over the same nodes as the image's,
/// differentiated term by term.
std::vector<float> quadrature_derivatives(const PixelRenderer& pixels,
                                          const VolumeIntegrator& water,
                                          const ChangedScenes& scenes, const PixelWindow& window,
                                          const ShareCallback& progress);

/// Of all light: means over `samples` random paths per pixel, without bias. `pixels`: with paths in
/// their light transport.
std::vector<float> path_derivatives(const PixelRenderer& pixels, const ChangedScenes& scenes,
                                    const PixelWindow& window, int samples,
                                    const ShareCallback& progress);

}  // namespace uw
