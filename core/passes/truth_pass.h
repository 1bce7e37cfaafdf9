#pragma once

#include "core/passes/pass.h"

namespace uw {

/// Renders ground truth: what the pixels' centres see, and where that is in other images. If
/// nothing moves while the shutter is open, the passes that render the pixels find it with their
/// own rays. Otherwise it is that of the middle of the exposure, for which this pass traces rays.
class TruthPass final : public Pass {
  public:
    /// What of a scene there is truth about: other frames and other cameras, in which points can
    /// be found, particles of volumes, and how these move.
    struct Subjects {
        bool frames = false, cameras = false, plume = false, moving_plume = false;
    };
    explicit TruthPass(const Subjects& subjects)
        : Pass(std::nullopt, Of::truth), subjects_(subjects) {}

    void provide(LayerSupply& supply) const override;
    void run(Rendering& rendering) override;

  private:
    Subjects subjects_;
};

}  // namespace uw
