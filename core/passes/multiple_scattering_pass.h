#pragma once

#include <memory>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/image/film.h"
#include "core/passes/pass.h"
#include "core/paths/distance_intervals.h"

namespace uw {

/// IntervalWeights all over a window of an image: found on rays of a lattice through the middles of
/// pixels that depends on the whole image alone, linear in between. One set of weights serves
/// uniform water.
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

/// Light that was scattered or reflected more than once, for the fast integrator: estimated by
/// light paths at the nodes of a lattice over the image (RadianceEstimator), smoothed between them
/// (LatticeFit), and interpolated: the water's by image position and distance, that on surfaces by
/// position among nodes that see the same surface. The reflectance and the water in front of the
/// surface are the pixel's own. Of the water's light, the surfaces' halo (SurfaceHalo) is as sharp
/// as they are: it is computed for all pixels, and what light paths find beside it is smoothed.
///
/// Nodes, their random numbers and the number of their paths depend on the whole image, so that
/// crops hold the same pixels, and a still camera does not flicker.
///
/// Each pixel's light is added to multiple_volume, multiple_surface and the lamps as it is
/// rendered, and its standard error by band to `error`, interpolated between those of the nodes
/// (NodeLattice::find_errors). What is stated of the image (ImageProgress::multiple_error) is the
/// RMS of that over the pixels, over the mean of all light. A transport without light paths, which
/// a caller may put in the place of the scene's, leaves this light out.
class MultipleScatteringPass final : public Pass {
  public:
    /// `share`: PathRequest::share.
    explicit MultipleScatteringPass(double share = 1);
    ~MultipleScatteringPass() override;

    PassNeeds needs(const LayerPlan& plan) const override;
    void provide(LayerSupply& supply) const override;
    void begin(Rendering& rendering) override;
    void run(Rendering& rendering) override;
    void end(Rendering& rendering) override;

  private:
    double share_;
    std::unique_ptr<class MultipleScattering>
        light_;                              // of the pixels, from run on; none: it is dark
    std::unique_ptr<class ErrorSums> sums_;  // over the pixels, from run on
};

}  // namespace uw
