#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/image/film.h"
#include "core/light/volume_integrator.h"
#include "core/passes/pixel_renderer.h"
#include "render/derivatives/contribution_gradient.h"
#include "render/derivatives/path_scores.h"

namespace uw {

/// Computes the derivatives of an image with respect to parameters of its scene, [change][pixel of
/// the window][band]: of the light in the image's `total`, per unit of the parameter. Pixels do not
/// depend on the window, nor results on the number of threads. Throws as require_memory, and
/// Interrupted.
///
/// The image of single scattering is a sum over quadrature nodes; this differentiates it term by
/// term.
std::vector<float> quadrature_derivatives(const PixelRenderer& pixels,
                                          const VolumeIntegrator& water,
                                          const ChangedScenes& scenes, const PixelWindow& window,
                                          const ProgressCallback& progress);

/// The random paths: their number per pixel, and their seed.
struct Draws {
    int samples = 1, seed = 0;  ///< >= 1, >= 0
};

/// The same for all light: unbiased means over random paths. The light transport of `pixels` must
/// have paths.
std::vector<float> path_derivatives(const PixelRenderer& pixels, const ChangedScenes& scenes,
                                    const PixelWindow& window, const Draws& draws,
                                    const ProgressCallback& progress);

/// An image of weights, [pixel of the window][band]: the derivative of some scalar, such as a loss,
/// with respect to the light of an image's pixels.
struct PixelWeights {
    PixelWindow window;
    std::size_t bands = 0;
    std::span<const double> values;

    std::span<const double> at(int x, int y) const {
        const auto row = static_cast<std::size_t>(y - window.y0);
        const auto column = static_cast<std::size_t>(x - window.x0);
        return values.subspan((row * static_cast<std::size_t>(window.width()) + column) * bands,
                              bands);
    }
};

/// The gradients that receive the derivatives of that scalar from one part of the image, which one
/// thread renders. Not empty.
using PartGradients = std::vector<std::unique_ptr<ContributionGradient>>;

/// Propagates the derivatives of that scalar to all `parts`, by single scattering as
/// quadrature_derivatives. It uses all nodes of each ray or, if `draws` is set, an unbiased random
/// selection of a few, as most of the time goes into following the path of each node.
void quadrature_gradient(const PixelRenderer& pixels, const VolumeIntegrator& water,
                         const PixelWeights& weights, const std::optional<Draws>& draws,
                         std::span<const PartGradients> parts, const ProgressCallback& progress);
/// The same for all light, as path_derivatives.
void path_gradient(const PixelRenderer& pixels, const PixelWeights& weights, const Draws& draws,
                   std::span<const PartGradients> parts, const ProgressCallback& progress);

}  // namespace uw
