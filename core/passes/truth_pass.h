#pragma once

#include "core/passes/pass.h"

namespace uw {

/// Ground truth: what the pixels' centres see, and where that is in other images. Where nothing
/// moves while the shutter is open, the passes that render the pixels find it with their rays;
/// of an exposure it is that of the middle, and takes rays of its own.
class TruthPass final : public Pass {
  public:
    /// Whether the scene has other frames and other cameras, in which to look for what is seen.
    TruthPass(bool has_other_frames, bool has_other_cameras)
        : Pass({}, Of::truth),
          has_other_frames_(has_other_frames),
          has_other_cameras_(has_other_cameras) {}

    void provide(LayerSupply& supply) const override;
    void run(Rendering& rendering) override;

  private:
    bool has_other_frames_, has_other_cameras_;
};

}  // namespace uw
