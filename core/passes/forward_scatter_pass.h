#pragma once

#include <memory>

#include "core/base/ray.h"
#include "core/passes/forward_scatter.h"
#include "core/passes/pass.h"

namespace uw {

/// The image as forward scatter blurs it: with the pixels per radian in the water at the centre of
/// the image; if the centre does not see through the port, at the closest position that does.
ScatterPlane scatter_plane(const RaySource& rays);

/// Forward scatter of a rendered image in the paper's four places (physics section 6), a second
/// pass over the pixels:
///
///     (14)  E     = E' + E' * g(R_lamps)      light falling on surfaces
///     (16)  L_s   = L_d + L_d * g(R_c)        the signal, with (14) in it
///     (17)  E_s   = E_s' + E_s' * g(R_lamps)  light scattered to the camera by a slab of water
///     (18)  L_b   = sum_i L_i + L_i * g(R_i)  each slab's light on its way to the camera,
///                                             with (17) in it
///
/// The light added by (14) and (16) is the layer `forward`; that added by (17) and (18) belongs to
/// `backscatter`. The blur acts on radiance in water, and the factor (PixelResult::pixel_factor) of
/// the pixel where it lands is applied afterwards; in the paper's output, (16) and (18) blur light
/// that carries the factor of the pixel it comes from. Slabs are processed a few at a time, so
/// memory does not grow with their number. The result does not depend on the number of threads.
///
/// Its step keeps what it needs of the pixels. The water is split into the integrator's slabs if it
/// sums slabs, else into slabs that grow with the distance.
class ForwardScatterPass final : public Pass {
  public:
    ForwardScatterPass();
    ~ForwardScatterPass() override;

    PassNeeds needs(const LayerPlan& plan) const override;
    void provide(LayerSupply& supply) const override;
    void begin(Rendering& rendering) override;
    void run(Rendering& rendering) override;

  private:
    std::unique_ptr<class ForwardScattering> scattering_;  // of what is rendered, from begin on
};

}  // namespace uw
