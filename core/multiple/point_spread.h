#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/multiple/distance_intervals.h"
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
/// [1/rad]. It is split by the distance s at which the light is scattered last, and the parts are
/// tabulated.
class PointSpread {
  public:
    /// Frequencies in the table: 4 to an octave.
    static constexpr std::size_t k_frequencies = 80;
    using Transfer = std::array<float, k_frequencies>;

    /// For surfaces up to the distance `farthest` [m].
    PointSpread(const Medium& medium, const DistanceIntervals& intervals, double farthest);

    /// A frequency of the table [1/rad]; they ascend.
    static double frequency(std::size_t index);

    /// The surfaces' distances in the table [m], ascending.
    std::span<const double> distances() const { return distances_; }
    /// The intervals in which light of these surfaces is scattered.
    std::size_t interval_count() const { return intervals_; }
    /// The transfer function of light that is scattered last in `interval`, for a surface at
    /// distances()[distance]: 0 if it lies before the interval.
    const Transfer& transfer(std::size_t interval, std::size_t band, std::size_t distance) const {
        return transfers_[(interval * bands_ + band) * distances_.size() + distance];
    }

  private:
    std::size_t bands_ = 0, intervals_ = 0;
    std::vector<double> distances_;
    std::vector<Transfer> transfers_;
};

}  // namespace uw
