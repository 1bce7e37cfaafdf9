#pragma once

#include <span>
#include <vector>

#include "core/multiple/cholesky.h"
#include "core/multiple/point_spread.h"

namespace uw {

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
