#pragma once

#include <span>
#include <vector>

#include "core/frame/multiple_nodes.h"
#include "core/frame/pixel_renderer.h"

namespace uw {

/// The radiance of surfaces that SurfaceGlow blurs: by direct light and emission, times by how much
/// the surfaces of the image are brighter, on the whole, by all light.
class GlowSource {
  public:
    /// Estimates that factor for each group and band. Both references must outlive this object.
    GlowSource(const PixelRenderer& pixels, const MultipleNodes& estimator);

    /// The radiance at the camera of `sample`, number `index` of `light`, by group and band. Thread
    /// safe.
    void find_radiance(const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
                       std::span<double> radiance) const;

  private:
    void find_gains();
    void add_direct(const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
                    std::span<double> radiance) const;

    const PixelRenderer& pixels_;
    const MultipleNodes& estimator_;
    std::size_t bands_;
    std::vector<double> gains_;  // by group and band
};

}  // namespace uw
