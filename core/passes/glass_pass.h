#pragma once

#include "core/passes/pass.h"

namespace uw {

/// Adds what pixels see through and mirrored in glass, whose surfaces PixelPass renders black: the
/// light of all legs of GlassView. Each sample of a pixel has surfaces of its own; the light that
/// the water scatters is that along the legs of one of them. Light that is scattered or reflected
/// more than once, if the scene has it, is that of light paths from each leg.
class GlassPass final : public Pass {
  public:
    /// `multiple`: whether the image has multiple scattering.
    explicit GlassPass(bool multiple);
    ~GlassPass() override;

    PassNeeds needs(const LayerPlan& plan) const override;
    void begin(Rendering& rendering) override;
    void run(Rendering& rendering) override;

  private:
    bool multiple_;
    std::unique_ptr<class GlassLight> light_;  // from begin on
};

}  // namespace uw
