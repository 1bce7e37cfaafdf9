#pragma once

#include <cstddef>
#include <vector>

#include "core/base/ray.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"

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
    /// Finds the weights of all water along a ray, whatever surfaces it meets:
    /// [interval * bands + band]. Where a surface cuts an interval, DistanceIntervals::share of it
    /// lies before the surface. Thread safe.
    void find(const Ray& ray, std::vector<float>& weights) const;
    /// The weights of uniform water, which are the same on all rays.
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
