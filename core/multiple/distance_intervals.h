#pragma once

#include <cstddef>
#include <vector>

#include "core/base/ray_source.h"
#include "core/integrators/lit_scene.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// Intervals of distance along all camera rays of an image, in which the water's light varies
/// little but for its attenuation. They depend on the scene and the camera, and on no part of the
/// image.
class DistanceIntervals {
  public:
    DistanceIntervals(const RaySource& rays, const LitScene& scene);

    std::size_t count() const { return ends_.size() - 1; }
    /// [m]; the first begins at 0, the last ends at k_far or beyond all that is seen.
    double begin(std::size_t interval) const { return ends_[interval]; }
    double end(std::size_t interval) const { return ends_[interval + 1]; }
    /// The interval that `distance` lies in.
    std::size_t at(double distance) const;
    /// The share of an interval's light in `band` that comes from before `distance`, for uniform
    /// water that glows evenly: 0..1.
    double share(std::size_t interval, std::size_t band, double distance) const;

  private:
    AttenuationTable attenuation_;
    std::vector<double> ends_;
};

}  // namespace uw
