#pragma once

#include <span>
#include <vector>

#include "core/frame/pixel_renderer.h"
#include "core/multiple/multiple_nodes.h"

namespace uw {

/// The radiance of surfaces that SurfaceGlow blurs: by direct light and emission, which are exact,
/// and roughly by the light that has been scattered or reflected before: as much as in proportion
/// to the direct light and, beside it, from an even ambient light explains most of it.
class GlowSource {
  public:
    /// Estimates the rough part for each group and band. Both references must outlive this object.
    GlowSource(const PixelRenderer& pixels, const MultipleNodes& estimator);

    /// The radiance at the camera of `sample`, number `index` of `light`, by group and band. Thread
    /// safe.
    void find_radiance(const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
                       std::span<double> radiance) const;

  private:
    struct Indirect {
        double per_direct = 0;
        double ambient = 0;  // what a white surface would reflect [W m^-2 sr^-1]
    };

    void find_indirect();
    void add_direct(const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
                    std::span<double> radiance) const;

    const PixelRenderer& pixels_;
    const MultipleNodes& estimator_;
    std::size_t bands_;
    std::vector<Indirect> indirect_;  // by group and band
};

}  // namespace uw
