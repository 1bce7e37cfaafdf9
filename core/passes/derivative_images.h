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
#include "core/paths/contribution_gradient.h"
#include "core/paths/path_scores.h"

namespace uw {

/// The derivatives of an image by numbers of its scene, [change][pixel of the window][band]: light
/// as the image's `total` holds it, per unit of the number. Pixels do not depend on the window, nor
/// results on the number of threads. Throws as require_memory, and
/// Interrupted.
///
/// The derivatives of light that was scattered or reflected once are the image's own sums over its
/// own nodes, differentiated term by term.
std::vector<float> quadrature_derivatives(const PixelRenderer& pixels,
                                          const VolumeIntegrator& water,
                                          const ChangedScenes& scenes, const PixelWindow& window,
                                          const ProgressCallback& progress);

/// What is drawn at random: how many light paths per pixel, and which of all that could be.
struct Draws {
    int samples = 1, seed = 0;  ///< >= 1, >= 0
};

/// The derivatives of all light are means over random paths, without bias. `pixels` must have paths
/// in their light transport.
std::vector<float> path_derivatives(const PixelRenderer& pixels, const ChangedScenes& scenes,
                                    const PixelWindow& window, const Draws& draws,
                                    const ProgressCallback& progress);

/// An image of weights, [pixel of the window][band]: the derivative of some number by the light of
/// an image's pixels.
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

/// Where derivatives of that number are gathered: those of a part of the image, which is rendered
/// in one thread. Not empty.
using PartGradients = std::vector<std::unique_ptr<ContributionGradient>>;

/// Gathers them for all parts, from all nodes of each ray, or, if there are `draws`, from a few
/// that stand for all without bias: following what each of them met is what takes the time.
/// Otherwise as quadrature_derivatives.
void quadrature_gradient(const PixelRenderer& pixels, const VolumeIntegrator& water,
                         const PixelWeights& weights, const std::optional<Draws>& draws,
                         std::span<const PartGradients> parts, const ProgressCallback& progress);
/// As path_derivatives.
void path_gradient(const PixelRenderer& pixels, const PixelWeights& weights, const Draws& draws,
                   std::span<const PartGradients> parts, const ProgressCallback& progress);

}  // namespace uw
