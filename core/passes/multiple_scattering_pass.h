#pragma once

#include <memory>

#include "core/image/film.h"
#include "core/passes/pass.h"

namespace uw {

class CameraRadianceCache;
class ErrorSums;
class MultipleScattering;

/// Multiple scattering for the fast integrator: the light that was scattered or reflected more than
/// once, traced into a CameraRadianceCache and interpolated by each pixel (MultipleScattering). The
/// parts of an exposure around one moment share its cache.
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
    MultipleScatteringPass(const MultipleScatteringPass&) = delete;
    MultipleScatteringPass(MultipleScatteringPass&&) = delete;
    MultipleScatteringPass& operator=(const MultipleScatteringPass&) = delete;
    MultipleScatteringPass& operator=(MultipleScatteringPass&&) = delete;

    PassNeeds needs(const LayerPlan& plan) const override;
    void provide(LayerSupply& supply) const override;
    void share(Rendering& middle) override;
    void begin(Rendering& rendering) override;
    void run(Rendering& rendering) override;
    void end(Rendering& rendering) override;

  private:
    std::shared_ptr<const CameraRadianceCache> trace(Rendering& rendering) const;

    double path_factor_;
    std::shared_ptr<const CameraRadianceCache> shared_;  // of the parts around a moment
    std::unique_ptr<MultipleScattering> light_;          // from run on; null: no light to scatter
    std::unique_ptr<ErrorSums> sums_;                    // over the pixels, from run on
};

}  // namespace uw
