#pragma once

#include "core/integrators/integrator.h"
#include "core/integrators/lit_scene.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// Single scattering in uniform water by adaptive Simpson quadrature in the scattering angle
/// (physics section 5): with D the lamp's distance from the ray and s_0 the ray's foot point,
/// R + s = s_0 + D tan(psi/2), so that
///
///     L_b = I/D e^(-c s_0) int V(psi) beta(psi) e^(-c D tan(psi/2)) dpsi,
///
/// without a peak at the lamp. An exact shadow ray at every node. Slow; validation's third opinion,
/// it shares no integration code with the other integrators. Throws std::invalid_argument for
/// water that varies.
class QuadratureIntegrator : public Integrator {
  public:
    /// `tolerance`: relative error of each ray's integral where it has no shadow edge.
    QuadratureIntegrator(const LitScene& scene, double tolerance);

    void in_scatter(const Ray& ray, std::span<const double> ends, InScatter& result) const override;
    void surface_lights(std::span<const SurfaceSample* const> samples,
                        SurfaceLight& light) const override;

  private:
    class RayIntegral;

    LitScene scene_;
    AttenuationTable attenuation_;
    double tolerance_;
};

}  // namespace uw
