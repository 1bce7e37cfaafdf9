#pragma once

#include <cstddef>
#include <vector>

#include "core/base/ray.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"

namespace uw {

/// Intervals of distance along the camera rays of an image, within which the in-scattered radiance
/// varies little but for its attenuation. They depend on the scene and the camera alone, whatever
/// part of the image is rendered.
class DistanceIntervals {
  public:
    DistanceIntervals(const RaySource& rays, const LitScene& scene);

    std::size_t count() const { return ends_.size() - 1; }
    /// The ends of an interval [m]: the first begins at 0, the last ends at k_far or beyond
    /// everything that is visible.
    double begin(std::size_t interval) const { return ends_[interval]; }
    double end(std::size_t interval) const { return ends_[interval + 1]; }
    /// The index of the interval that contains `distance`.
    std::size_t at(double distance) const;
    /// The fraction (0..1) of an interval's light in `band` that comes from before `distance`, if
    /// uniform water has the same source radiance everywhere:
    ///     (1 - e^(-c (distance - begin))) / (1 - e^(-c (end - begin))).
    double fraction_before(std::size_t interval, std::size_t band, double distance) const;

  private:
    AttenuationTable attenuation_;
    std::vector<double> ends_;
};

/// The light that the water of each interval scatters to the camera if the radiance around it is 1
/// everywhere: int b e^-tau ds along a ray, by interval and band. The light that paths find in an
/// interval, divided by this weight, is a mean radiance, which varies little from ray to ray
/// however sharp the concentrations are.
class IntervalWeights {
  public:
    /// The scene and the intervals must outlive this object.
    IntervalWeights(const LitScene& scene, const DistanceIntervals& intervals);

    const DistanceIntervals& intervals() const { return intervals_; }

    /// Whether the weights differ from ray to ray.
    bool vary() const { return !scene_.field->bounds().empty(); }
    /// Computes the weights of all water along a ray, as if no surface ended it: [interval * bands
    /// + band]. Where a surface cuts an interval, multiply by DistanceIntervals::fraction_before.
    /// Thread safe.
    void find(const Ray& ray, std::vector<float>& weights) const;
    /// The weights of uniform water, which are the same on all rays.
    const std::vector<float>& of_uniform_water() const { return uniform_weights_; }

  private:
    void add_uniform(double begin, double end, std::size_t interval,
                     std::vector<float>& weights) const;
    void add_profile(const ConcentrationProfile& profile, std::vector<float>& weights) const;

    LitScene scene_;
    const DistanceIntervals& intervals_;
    AttenuationTable attenuation_;
    DepthTolerance tolerance_;
    std::size_t bands_;
    Spectrum scattering_;                 // of the uniform water [1/m]
    std::vector<Spectrum> per_unit_;      // of the constituents [1/m per unit]
    std::vector<float> uniform_weights_;  // of uniform water, [interval * bands + band]
};

}  // namespace uw
