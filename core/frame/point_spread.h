#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/frame/distance_intervals.h"
#include "core/optics/medium.h"

namespace uw {

/// Light from a surface that uniform water scatters by small angles, any number of times, on its
/// way to the camera: the surface's own radiance at the camera, blurred. In the small-angle
/// approximation (Wells 1973) the optical transfer function of water between the camera and a
/// surface at the distance T, relative to what is not scattered, is
///
///     exp( b int_0^T p^(k (T - s) / T) ds ) - 1,
///
/// with the phase function's Hankel transform p^(k) and angular frequencies k as seen by the camera
/// [1/rad]. It is split by the distance s at which the light is scattered last, and each part is
/// written as a sum of Gaussians, the weights of which are tabulated.
class PointSpread {
  public:
    static constexpr std::size_t k_components = 12;
    using Weights = std::array<float, k_components>;

    /// For surfaces up to the distance `farthest` [m].
    PointSpread(const Medium& medium, const DistanceIntervals& intervals, double farthest);

    /// Standard deviation of a component [rad].
    static double deviation(std::size_t component);

    /// The surfaces' distances for which there are weights [m], ascending.
    std::span<const double> distances() const { return distances_; }
    /// The intervals in which light of these surfaces is scattered.
    std::size_t interval_count() const { return intervals_; }
    /// The components' weights for light that is scattered last in `interval`, for a surface at
    /// distances()[distance]: 0 if it lies before the interval.
    const Weights& weights(std::size_t interval, std::size_t band, std::size_t distance) const {
        return weights_[(interval * bands_ + band) * distances_.size() + distance];
    }

  private:
    std::size_t bands_ = 0, intervals_ = 0;
    std::vector<double> distances_;
    std::vector<Weights> weights_;
};

}  // namespace uw
