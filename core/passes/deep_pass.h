#pragma once

#include "core/passes/pass.h"

namespace uw {

/// Distributes the light of each pixel over the distances from which it comes, into the deep image
/// (Rendering::deep) if there is one: stretches of water, in which most opacity or light is added,
/// and the surfaces that the pixel's samples hit. What the samples hide follows one function of the
/// distance, the mean over bands and samples of the transmittance, since deep pixels have one
/// alpha; their colours are the light that arrives divided by that of all samples before, so that
/// the flattened pixel is the image's (OpenEXR, "Interpreting Deep Pixels").
class DeepPass final : public Pass {
  public:
    DeepPass() : Pass(std::nullopt) {}

    /// Throws InputError, when pixels are rendered, for a ray that does not go forwards along the
    /// camera's axis, along which depth is measured.
    void begin(Rendering& rendering) override;
    void run(Rendering& /*rendering*/) override {}
};

}  // namespace uw
