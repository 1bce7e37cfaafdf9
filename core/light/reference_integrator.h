#pragma once

#include <utility>
#include <vector>

#include "core/light/integrator.h"
#include "core/light/integrator_kind.h"
#include "core/light/lamps_in_view.h"
#include "core/light/medium.h"
#include "core/light/sky_emitter.h"
#include "core/light/surface_lighting.h"

namespace uw {

/// The slow, straightforward integrator against which the fast one is judged: it marches each ray
/// in small steps and, at every sample, traces a shadow ray and integrates exact columns to the
/// lamp and the camera. No caches, no deep shadow maps. Physics section 5.
class ReferenceIntegrator final : public Integrator {
  public:
    /// For any scene; meant for comparison, so every pixel is integrated by itself.
    static const IntegratorKind k_kind;

    /// `step`: step length relative to the distance from the lamp; for a sun, relative to the
    /// distance over which its light falls to 1/e, or to a tenth of the distance along the ray if
    /// that is greater. Inside the field's bounds, steps are never longer than a quarter of the
    /// finest voxel, nor than an optical depth of 20 `step`. The error falls as step^2, but only as
    /// step at shadow edges.
    explicit ReferenceIntegrator(const LitScene& scene, double step = 0.005);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;

  private:
    /// The least and the greatest attenuation coefficient of the bands [1/m].
    std::pair<double, double> attenuation_at(const Point3& x) const;
    /// The light of a part of the sky on a ray (SkyScattering::find).
    struct SkyLight {
        std::vector<double> phase;
        double lengthening = 1;
    };
    /// In-scatter per metre at distance `s` of `ray` from an emitter [W m^-3 sr^-1]. `sky`: null if
    /// that is no part of the sky.
    Spectrum in_scatter_per_metre(const Ray& ray, double s, std::size_t emitter,
                                  const SkyLight* sky) const;

    LitScene scene_;
    LampEvenness evenness_;
    SkyScattering sky_;
    AttenuationTable attenuation_;
    double step_;
};

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
    LampEvenness evenness_;
    SkyScattering sky_;
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
