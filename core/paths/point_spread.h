#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/light/medium.h"
#include "core/paths/distance_intervals.h"
#include "core/paths/lattice_fit.h"

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

/// A sum of images, each blurred by another width: level 0 is as it was, level l is blurred by a
/// smooth kernel, nearly a Gaussian, of the standard deviation `deviation(l)`, computed at
/// 1 / 2^(l-1) of the resolution (Burt & Adelson 1983). Beyond its edges an image goes on with the
/// values there. Reused storage.
class BlurPyramid {
  public:
    /// The standard deviation of level `level` [pixels]: 0, 0.7, 1.9, 4.0, …
    static double deviation(int level);
    /// The transfer function of `level` along an axis at the frequency `omega` [rad per pixel].
    static double transfer(int level, double omega);
    /// So many levels that the last is computed from one pixel.
    static int level_count(int width, int height);

    /// Starts a sum of nothing.
    void begin(int width, int height);
    /// Adds `image`, blurred by `level`; its contents are unspecified afterwards.
    void add(int level, Grid2D<float>& image);
    /// The sum; valid until the next call of begin.
    const Grid2D<float>& sum();

  private:
    Grid2D<float> unblurred_;            // level 0
    std::vector<Grid2D<float>> levels_;  // from level 1 on
    Grid2D<float> rows_, coarse_;
};

/// Makes a PointSpread's transfer function of the levels of a BlurPyramid.
class BlurFit {
  public:
    /// For pixels of the angle `pixel` [rad].
    BlurFit(int levels, double pixel);

    /// The weights of the levels that sum up best to `transfer` as pixels show it, by least squares
    /// over the logarithm of the frequency, as an edge weighs them. Surfaces and light are means
    /// over pixels, and frequencies beyond the highest of an image look like lower ones.
    void fit(const PointSpread::Transfer& transfer, std::span<double> weights) const;

  private:
    // What a frequency beyond that of the image adds to one within.
    struct Alias {
        std::size_t index;  // of the transfer function below it
        double below, above;
    };

    std::size_t levels_, frequencies_ = 0;
    std::vector<double> shares_;     // by frequency, of what is within
    std::vector<Alias> aliases_;     // by frequency
    std::vector<double> responses_;  // by level and frequency
    CholeskyFactor normal_;
};

}  // namespace uw
