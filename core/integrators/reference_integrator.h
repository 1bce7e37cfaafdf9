#pragma once

#include "core/integrators/integrator_kind.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// The slow, obvious integrator that the fast one is judged by: marches each ray in small steps
/// and, at every sample, traces a shadow ray and integrates exact columns to lamp and camera.
/// No caches, no deep shadow maps. Physics section 5.
class ReferenceIntegrator final : public Integrator {
  public:
    /// For every scene, and for comparison: every pixel by itself.
    static const IntegratorKind k_kind;

    /// `step`: length of a sample relative to its distance from the lamp; samples are never longer
    /// than a quarter of the finest voxel inside the field's bounds. The error falls as step^2,
    /// and as step at shadow edges.
    explicit ReferenceIntegrator(const LitScene& scene, double step = 0.005);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;

  private:
    /// In-scatter per metre at distance `s` of `ray` from lamp `lamp` [W m^-3 sr^-1].
    Spectrum in_scatter_per_metre(const Ray& ray, double s, std::size_t lamp) const;

    LitScene scene_;
    AttenuationTable attenuation_;
    double step_;
};

}  // namespace uw
