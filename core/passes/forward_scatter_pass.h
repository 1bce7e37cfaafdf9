#pragma once

#include <memory>

#include "core/base/ray.h"
#include "core/passes/forward_scatter.h"
#include "core/passes/pass.h"

namespace uw {

/// Returns the image plane that forward scatter blurs, with the pixels per radian in the water at
/// the image's centre or, if the centre does not see through the port, at the closest position that
/// does.
ScatterPlane scatter_plane(const RaySource& rays);

/// Adds forward scatter to a rendered image, a second pass over its pixels, in four places as in
/// the paper (physics section 6):
///
///     (14)  E     = E' + E' * g(R_lamps)      light falling on surfaces
///     (16)  L_s   = L_d + L_d * g(R_c)        the signal, with (14) in it
///     (17)  E_s   = E_s' + E_s' * g(R_lamps)  light scattered to the camera by a slab of water
///     (18)  L_b   = sum_i L_i + L_i * g(R_i)  each slab's light on its path to the camera,
///                                             with (17) in it
///
/// The layer `forward` contains the light added by (14) and (16); that added by (17) and (18)
/// belongs to `backscatter`. The blur acts on radiance in water, and the factor
/// (PixelResult::pixel_factor) of the pixel where the light arrives is applied afterwards. In the
/// paper's output, however, (16) and (18) blur light to which the factor of its own pixel has been
/// applied. Slabs are processed a few at a time, so that memory does not grow with their number.
/// The result does not depend on the number of threads.
///
/// The pass's step stores what it needs of each pixel. The water is split into the integrator's
/// slabs, if it sums slabs, and otherwise into slabs whose thickness grows with the distance.
class ForwardScatterPass final : public Pass {
  public:
    ForwardScatterPass();
    ~ForwardScatterPass() override;

    PassNeeds needs(const LayerPlan& plan) const override;
    void provide(LayerSupply& supply) const override;
    void begin(Rendering& rendering) override;
    void run(Rendering& rendering) override;

  private:
    std::unique_ptr<class ForwardScattering> scattering_;  // of the current image, from begin on
};

}  // namespace uw
