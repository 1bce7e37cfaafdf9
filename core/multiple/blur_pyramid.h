#pragma once

#include <vector>

#include "core/base/grid2d.h"

namespace uw {

/// A sum of images, each blurred by another width: level 0 is as it was, level l is blurred by a
/// smooth kernel, nearly a Gaussian, of the standard deviation `deviation(l)`, computed at
/// 1 / 2^(l-1) of the resolution (Burt & Adelson 1983). Beyond its edges an image goes on with the
/// values there. Reused storage.
class BlurPyramid {
  public:
    /// Of level `level`, in pixels: 0, 0.7, 1.9, 4.0, …
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

}  // namespace uw
