#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace uw {

/// The scene of an image with one of its parameters, or several together, a little less and a
/// little more than in the image.
struct ChangedScene {
    std::string name;  // the parameter's key, such as "lamps[0].position"; begins messages
    ImageScene less, more;
    double step = 0;  // difference of the parameter between the two
};

/// Options of derivatives of an image.
struct DerivativeOptions {
    std::optional<PixelWindow> window{};  ///< the pixels to differentiate; none: the whole image
    int seed = 0;                         ///< of random paths and selections, >= 0
};

/// Returns the derivatives of the image of the renderer's scene with respect to these parameters,
/// band by band: [change][pixel of options.window, row by row][band], of the layer `total`, per
/// unit of the parameter. Parameters may be of the water, its particles and volumes, of the lamps,
/// and of the reflectance and emission of surfaces.
///
/// Single scattering is differentiated term by term at the nodes of the integrator volume. Multiple
/// scattering, and scenes of the integrator path, are differentiated by random paths, as many per
/// pixel as the image has samples (derivative_images.h), without bias but with noise. The motion of
/// discontinuities (the edges of shadows and of beams with sharp edges) is not included. The
/// renderer has the same scene afterwards. Throws UsageError, which says why, for images whose
/// light is not a sum over paths (forward scatter, snow, exposures with motion, bands with rays of
/// their own, the paper's output) and for changes of anything else; and as Renderer.
std::vector<float> scene_derivatives(Renderer& renderer, std::span<const ChangedScene> changes,
                                     const DerivativeOptions& options,
                                     const ProgressCallback& progress);

/// Returns the derivatives of the image with respect to each of
///
/// - "water.absorption", "water.scattering": the uniform water's coefficient in each band, its
///   phase function as it is [per 1/m]. Bands do not affect each other: each pixel has one
///   derivative per band.
/// - "water.particles.small", "water.particles.large": the concentration of the water's own
///   particles (with_one_more_ppm) [per ppm].
/// - "concentration.NAME": a factor on all concentrations of a constituent of the volumes, at 1.
///
/// Otherwise as scene_derivatives, for which the scene has to contain a parameter's key. Throws
/// UsageError for other names.
std::vector<float> named_derivatives(Renderer& renderer, std::span<const std::string> names,
                                     const DerivativeOptions& options,
                                     const ProgressCallback& progress);

/// The parameters with respect to which a scalar is differentiated, all in one pass over the image.
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

/// Returns the gradient of a scalar, such as a loss, from `weights` [pixel][band], its derivatives
/// with respect to the light of the pixels of options.window, row by row: the transpose of
/// scene_derivatives. Unless the image's quality is exact, a random selection of each ray's nodes
/// is used, without bias. The time hardly depends on the number of parameters. Derivatives are 0
/// where there is no scattering or reflection, even if a change of the parameter would add some.
/// Throws UsageError for volumes and textures that are not in memory, and as scene_derivatives.
SceneGradient scene_gradient(Renderer& renderer, const GradientRequest& by,
                             std::span<const double> weights, const DerivativeOptions& options,
                             const ProgressCallback& progress);

}  // namespace uw
