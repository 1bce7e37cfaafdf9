#pragma once

#include "core/integrators/integrator.h"
#include "core/integrators/lit_scene.h"
#include "core/integrators/surface_lighting.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// Single scattering in uniform water by adaptive Simpson quadrature in the scattering angle
/// (physics section 5): with D the lamp's distance from the ray and s_0 the position along the ray
/// nearest to it, R + s = s_0 + D tan(psi/2), so that
///
///     L_b = I/D e^(-c s_0) int V(psi) beta(psi) e^(-c D tan(psi/2)) dpsi,
///
/// which has no peak at the lamp. Traces an exact shadow ray at every node. Slow; an independent
/// third implementation for validation, which shares no integration code with the other
/// integrators.
class QuadratureIntegrator final : public Integrator {
  public:
    /// `tolerance`: relative error of each ray's integral in the absence of shadow edges. Throws
    /// std::invalid_argument for water that varies in space.
    QuadratureIntegrator(const LitScene& scene, double tolerance);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;

  private:
    class RayIntegral;

    LitScene scene_;
    AttenuationTable attenuation_;
    double tolerance_;
};

/// Light on surfaces in uniform water in closed form, one sample and one lamp at a time: an
/// independent check on DirectLighting.
class UniformWaterLighting final : public SurfaceLighting {
  public:
    /// Throws std::invalid_argument for water that varies.
    explicit UniformWaterLighting(const LitScene& scene);

    void evaluate(std::span<const SurfaceSample* const> samples,
                  SurfaceLight& light) const override;

  private:
    LitScene scene_;
    AttenuationTable attenuation_;
};

}  // namespace uw
