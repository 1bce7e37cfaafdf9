#pragma once

#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray_source.h"
#include "core/image/film.h"
#include "core/multiple/interval_weights.h"

namespace uw {

/// IntervalWeights all over a window of an image: found on rays of a lattice that depends on the
/// whole image alone, linear in between. One set of weights serves uniform water.
class WeightLattice {
  public:
    WeightLattice() = default;
    /// Reads its arguments only here.
    WeightLattice(const RaySource& rays, const IntervalWeights& weights, const PixelWindow& window);

    /// At an image position [pixels] in the window: [interval * bands + band]. Thread safe.
    void find(double x, double y, std::vector<float>& weights) const;

  private:
    int spacing_ = 1, column_ = 0, row_ = 0;  // [pixels]; the first ray's place
    std::vector<float> uniform_;
    Grid2D<std::vector<float>> rays_;  // empty: uniform everywhere
};

}  // namespace uw
