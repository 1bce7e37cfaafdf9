#pragma once

#include "core/passes/pass.h"

namespace uw {

/// Ground truth: what the pixels' centres see, and where that is in other images. Where nothing
/// moves while the shutter is open, the passes that render the pixels find it with their rays;
/// of an exposure it is that of the middle, and takes rays of its own.
class TruthPass final : public Pass {
  public:
    explicit TruthPass(const SceneDesc& scene);

    void provide(LayerSupply& supply) const override;
    void run(Rendering& rendering) override;

  private:
    bool has_other_frames_, has_other_cameras_;
};

}  // namespace uw
