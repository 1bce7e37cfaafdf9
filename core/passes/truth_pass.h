#pragma once

#include "core/passes/pass.h"

namespace uw {

/// Renders ground truth: what the pixels' centres see, and where that is in other images. If
/// nothing moves while the shutter is open, the passes that render the pixels find it with their
/// own rays. Otherwise it is that of the middle of the exposure, for which this pass traces rays.
class TruthPass final : public Pass {
  public:
    /// The arguments say whether the scene has other frames and other cameras in which points can
    /// be found.
    TruthPass(bool has_other_frames, bool has_other_cameras)
        : Pass(std::nullopt, Of::truth),
          has_other_frames_(has_other_frames),
          has_other_cameras_(has_other_cameras) {}

    void provide(LayerSupply& supply) const override;
    void run(Rendering& rendering) override;

  private:
    bool has_other_frames_, has_other_cameras_;
};

}  // namespace uw
