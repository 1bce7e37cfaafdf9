#pragma once

#include <functional>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray_source.h"
#include "core/integrators/integrator.h"

namespace uw {

/// How much of the light that the water scatters towards a pixel comes from how far: on a lattice
/// over the image, as the mean over all bands. For what particles hide of it, which is little.
class WaterVeil {
  public:
    /// `depth`: of the particles drawn (SnowModel::drawn_depth).
    WaterVeil(const RaySource& rays, const Integrator& integrator,
              const std::function<double(double distance)>& depth);

    /// The share of the water's light at an image position that comes from beyond `distance`, if it
    /// ends at `end` [m]; 0 if there is none.
    double share_beyond(double x, double y, double distance, double end) const;
    /// e^-depth, as a mean over the water's light that ends at `end`; 1 if there is none.
    double mean_transmittance(double x, double y, double end) const;

  private:
    struct Light {
        double all = 0, transmitted = 0;
    };
    Light light_up_to(double x, double y, double distance) const;

    std::vector<double> distances_;
    Grid2D<std::vector<Light>> nodes_;  // up to each of the distances
};

}  // namespace uw
