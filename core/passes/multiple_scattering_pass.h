#pragma once

#include <memory>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/image/film.h"
#include "core/passes/pass.h"
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

/// Multiple scattering for the fast integrator: the light that was scattered or reflected more than
/// once. Light paths estimate it at the nodes of a lattice over the image (RadianceEstimator),
/// LatticeFit smooths it, and each pixel interpolates it, as in an irradiance or radiance cache
/// (Ward et al. 1988; Jarosz et al. 2008): in-scattered light by image position and distance, light
/// on surfaces by position among the nodes that see the same surface. Each pixel uses its own
/// reflectance and its own transmittance. The halo of the surfaces (SurfaceHalo), a part of the
/// in-scattered light, has edges as sharp as theirs, so it is computed for every pixel; only the
/// rest of what light paths find is smoothed.
///
/// The nodes, their random numbers and the number of their paths depend on the whole image alone,
/// so that crops have the same pixels, and the frames of a still camera do not flicker.
///
/// The light is added to multiple_volume, multiple_surface and the lamps of each pixel when it is
/// rendered, and its standard error by band to `error`, interpolated between the nodes
/// (NodeLattice::find_errors). The error of the image (ImageProgress::multiple_error) is the RMS of
/// the pixels' errors divided by the mean of all light. Nothing is added if LightTransport has no
/// paths.
class MultipleScatteringPass final : public Pass {
  public:
    /// `path_factor`: PathRequest::path_factor.
    explicit MultipleScatteringPass(double path_factor = 1);
    ~MultipleScatteringPass() override;

    PassNeeds needs(const LayerPlan& plan) const override;
    void provide(LayerSupply& supply) const override;
    void begin(Rendering& rendering) override;
    void run(Rendering& rendering) override;
    void end(Rendering& rendering) override;

  private:
    double path_factor_;
    std::unique_ptr<class MultipleScattering> light_;  // from run on; null: no light to scatter
    std::unique_ptr<class ErrorSums> sums_;            // over the pixels, from run on
};

}  // namespace uw
