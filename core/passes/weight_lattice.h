#pragma once

#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/image/film.h"
#include "core/paths/distance_intervals.h"

namespace uw {

/// Interpolates IntervalWeights over a window of an image. They are computed on a lattice of camera
/// rays through pixel centres, and are linear in between. The lattice depends on the whole image
/// alone, not on the window. In uniform water, one set of weights serves all rays.
class WeightLattice {
  public:
    WeightLattice() = default;
    /// The arguments need not outlive the constructor.
    WeightLattice(const RaySource& rays, const IntervalWeights& weights, const PixelWindow& window);

    /// Sets `weights` to those at an image position [pixels] in the window: [interval * bands +
    /// band]. Thread safe.
    void find(double x, double y, std::vector<float>& weights) const;

  private:
    int spacing_ = 1, column_ = 0, row_ = 0;  // [pixels]; indices of the first ray
    std::vector<float> uniform_;
    Grid2D<std::vector<float>> rays_;  // empty: uniform_ holds everywhere
};

}  // namespace uw
