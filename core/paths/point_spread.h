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

/// The point spread function of uniform water: light from a surface that is scattered by small
/// angles, any number of times, on its way to the camera. It is the surface's unscattered radiance
/// at the camera, blurred. In the small-angle approximation (Wells 1973) the optical transfer
/// function of the water between the camera and a surface at the distance T, relative to the
/// unscattered light, is
///
///     exp( b int_0^T p^(k (T - s) / T) ds ) - 1,
///
/// with the phase function's Hankel transform p^(k) and angular frequencies k as seen by the camera
/// [1/rad]. It is split by the distance s of the scattering nearest to the camera, and the parts
/// are tabulated.
class PointSpread {
  public:
    /// The number of tabulated frequencies, 4 per octave.
    static constexpr std::size_t k_frequencies = 80;
    using Transfer = std::array<float, k_frequencies>;

    /// Tabulates for surfaces up to the distance `farthest` [m].
    PointSpread(const Medium& medium, const DistanceIntervals& intervals, double farthest);

    /// A frequency of the table [1/rad]; they ascend.
    static double frequency(std::size_t index);

    /// The surfaces' distances in the table [m], ascending.
    std::span<const double> distances() const { return distances_; }
    /// The number of intervals in which light of these surfaces is scattered.
    std::size_t interval_count() const { return intervals_; }
    /// The transfer function of light whose scattering nearest to the camera is in `interval`, for
    /// a surface at distances()[distance]; 0 if the surface is in front of the interval.
    const Transfer& transfer(std::size_t interval, std::size_t band, std::size_t distance) const {
        return transfers_[(interval * bands_ + band) * distances_.size() + distance];
    }

  private:
    std::size_t bands_ = 0, intervals_ = 0;
    std::vector<double> distances_;
    std::vector<Transfer> transfers_;
};

/// A sum of images, each blurred by a width of its own: level 0 is not blurred, level l is blurred
/// by a smooth, nearly Gaussian kernel of the standard deviation `deviation(l)`, at 1 / 2^(l-1) of
/// the resolution (Burt & Adelson 1983). Images are continued beyond their edges by the values
/// there. Storage is reused.
class BlurPyramid {
  public:
    /// The standard deviation of level `level` [pixels]: 0, 0.7, 1.9, 4.0, …
    static double deviation(int level);
    /// The transfer function of `level` along an axis at the frequency `omega` [rad per pixel].
    static double transfer(int level, double omega);
    /// The number of levels for an image of this size: the last is computed from a single pixel.
    static int level_count(int width, int height);

    /// Resets the sum to 0.
    void begin(int width, int height);
    /// Adds `image`, blurred by `level`; its contents are unspecified afterwards.
    void add(int level, Grid2D<float>& image);
    /// The sum of all images added; valid until the next call of begin.
    const Grid2D<float>& sum();

  private:
    Grid2D<float> unblurred_;            // level 0
    std::vector<Grid2D<float>> levels_;  // from level 1 on
    Grid2D<float> rows_, coarse_;
};

/// Approximates a PointSpread's transfer function by a weighted sum of the levels of a BlurPyramid.
class BlurFit {
  public:
    /// `pixel`: the angle of a pixel [rad].
    BlurFit(int levels, double pixel);

    /// The weights of the levels whose sum fits `transfer` best, as pixels show it: by least
    /// squares over the logarithm of the frequency, as an edge weighs them. Surfaces and light are
    /// means over pixels, and frequencies beyond the Nyquist frequency alias to lower ones.
    void fit(const PointSpread::Transfer& transfer, std::span<double> weights) const;

  private:
    // The contribution of a frequency beyond Nyquist to its alias within.
    struct Alias {
        std::size_t index;  // of the tabulated frequency below it
        double below, above;
    };

    std::size_t levels_, frequencies_ = 0;
    std::vector<double> pixel_transfers_;  // by frequency
    std::vector<Alias> aliases_;           // by frequency
    std::vector<double> responses_;        // by level and frequency
    CholeskyFactor normal_;
};

}  // namespace uw
