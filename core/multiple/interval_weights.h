#pragma once

#include <cstddef>
#include <vector>

#include "core/base/ray.h"
#include "core/integrators/lit_scene.h"
#include "core/multiple/distance_intervals.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// How much of the light around it the water of each interval of distance scatters to the camera,
/// if that light is the same from everywhere: int b e^-tau ds along a ray, by interval and band.
/// What light paths find in an interval, divided by this, is a mean radiance; it varies little from
/// ray to ray however sharp the concentrations are.
class IntervalWeights {
  public:
    /// The scene and the intervals must outlive this object.
    IntervalWeights(const LitScene& scene, const DistanceIntervals& intervals);

    const DistanceIntervals& intervals() const { return intervals_; }

    /// Whether they differ from ray to ray.
    bool vary() const { return !scene_.field->bounds().empty(); }
    /// Of all water along a ray, whatever surfaces it meets: [interval * bands + band]. Of an
    /// interval that a surface cuts, DistanceIntervals::share lies before it. Thread safe.
    void find(const Ray& ray, std::vector<float>& weights) const;
    /// Those of uniform water, which are the same on all rays.
    const std::vector<float>& of_uniform_water() const { return whole_; }

  private:
    void add_uniform(double begin, double end, std::size_t interval,
                     std::vector<float>& weights) const;
    void add_profile(const ConcentrationProfile& profile, std::vector<float>& weights) const;

    LitScene scene_;
    const DistanceIntervals& intervals_;
    AttenuationTable attenuation_;
    DepthTolerance tolerance_;
    std::size_t bands_;
    Spectrum scattering_;             // of the uniform water [1/m]
    std::vector<Spectrum> per_unit_;  // of the constituents [1/m per unit]
    std::vector<float> whole_;        // of the uniform water's intervals
};

}  // namespace uw
