#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace uw {

/// The scene of an image with one of its numbers, or several together, a little less and a little
/// more than it has them.
struct ChangedScene {
    std::string name;  // the number's key, "lamps[0].position"; begins messages
    ImageScene less, more;
    double step = 0;  // by how much the number differs between the two
};

/// What of an image is differentiated, and how.
struct DerivativeOptions {
    std::optional<PixelWindow> window{};  ///< none: the whole image
    int seed = 0;                         ///< of what is drawn at random, >= 0
};

/// The derivatives of the image of the scene that `renderer` has by these numbers, band by band:
/// [change][pixel of options.window, row by row][band], as `total` has light, per unit of the
/// number. Of numbers of the water, its particles and volumes, of the lamps, and of what surfaces
/// reflect and emit.
///
/// Light scattered once is differentiated term by term at the nodes of the integrator volume; all
/// light, and scenes of the integrator path, by random paths, as many per pixel as the image's
/// samples (core/passes/derivative_images.h): without bias, and with noise. What a
/// number moves in the image (the edge of a shadow, or of a beam that ends at once) is not in it.
/// The renderer has the same scene afterwards. Throws UsageError for images whose light is not a
/// sum over paths (forward scatter, snow, exposures with motion, bands with rays of their own, the
/// paper's output) and for changes of anything else, saying why; and as Renderer.
std::vector<float> scene_derivatives(Renderer& renderer, std::span<const ChangedScene> changes,
                                     const DerivativeOptions& options,
                                     const ProgressCallback& progress);

/// The derivatives of the image by each of
///
/// - "water.absorption", "water.scattering": the uniform water's coefficient in each band, its
///   phase function as it is [per 1/m]. Bands do not affect each other: each pixel has one
///   derivative per band.
/// - "water.particles.small", "water.particles.large": the concentration of the water's own
///   particles (particle_derivative) [per ppm].
/// - "concentration.NAME": a factor on all concentrations of a constituent of the volumes, at 1.
///
/// As scene_derivatives, which differ in that a key of the scene has to be written there; throws
/// UsageError for other names.
std::vector<float> named_derivatives(Renderer& renderer, std::span<const std::string> names,
                                     const DerivativeOptions& options,
                                     const ProgressCallback& progress);

/// What a number is differentiated by, all in one pass over the image.
struct GradientRequest {
    std::span<const ChangedScene> changes{};  ///< as of scene_derivatives
    std::span<const std::size_t> volumes{};  ///< the values of these, in memory (VolumeDesc::array)
    std::span<const std::size_t> textures{};  ///< those of these entries of geometry, in memory
};

struct SceneGradient {
    std::vector<double> by_change;
    /// By value (i, j, k) of each volume: [(i * size[1] + j) * size[2] + k] of LoadedGrid::size.
    std::vector<std::vector<float>> by_voxel;
    /// By texel of each texture: [(row * width + column) * 3 + colour], linear red, green and blue.
    std::vector<std::vector<float>> by_texel;
};

/// The derivatives of a number from its derivatives by the light of the pixels of options.window,
/// row by row, `weights` [pixel][band]: the transpose of scene_derivatives. Unless the image's
/// quality is exact, some nodes of each ray stand for all, without bias: the time hardly depends on
/// how many numbers there are. Where nothing scatters or reflects, it is as if nothing were added
/// that does. Throws UsageError for volumes and textures that are not in memory, and as
/// scene_derivatives.
SceneGradient scene_gradient(Renderer& renderer, const GradientRequest& by,
                             std::span<const double> weights, const DerivativeOptions& options,
                             const ProgressCallback& progress);

}  // namespace uw
