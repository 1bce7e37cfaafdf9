#pragma once

#include <memory>
#include <vector>

#include "core/integrators/integrator_kind.h"
#include "core/integrators/panel_breaks.h"
#include "core/integrators/ray_panels.h"
#include "core/integrators/scatter_nodes.h"

namespace uw {

/// Deterministic quadrature of single scattering (physics section 5) over precomputed (splatted)
/// light: Gauss rules on panels that follow octaves of the distance to the lamp, the phase
/// functions' breakpoints, lit intervals, voxels and the lamp's columns.
class VolumeIntegrator final : public Integrator {
  public:
    /// For every scene whose lamps have been splatted.
    static const IntegratorKind k_kind;

    /// How finely a ray's panels resolve the light on it.
    struct Fineness {
        // Knots of the concentrations per panel, which has at least two nodes; large values are
        // for drafts.
        int knots_per_panel = 2;
        // A break that only marks a change of scale is dropped if its predecessor is closer than
        // this, relative to the distance from the lamp.
        double least_relative_panel = 0.35;
        int pieces = 1;  // that every panel is cut into at least
    };

    /// `deep_shadows`: one per emitter of `scene`. `tolerance`: of the concentrations along a ray.
    VolumeIntegrator(const LitScene& scene,
                     std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                     const DepthTolerance& tolerance, const Fineness& fineness);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                         InScatter& result) const override;

  private:
    struct Workspace;

    // Where panels begin and end within a lit interval of lamp `lamp`, ascending.
    const std::vector<double>& find_breaks(const Ray& ray, std::size_t lamp,
                                           const LampPassage& passage, const Interval& interval,
                                           std::span<const double> distances, Workspace& w) const;
    void add_panels(const Ray& ray, std::size_t lamp, const LampPassage& passage,
                    std::span<const double> distances, std::span<const double> breaks,
                    const ConcentrationProfile& profile, ScatterNodes& nodes) const;

    LitScene scene_;
    DepthTolerance tolerance_;
    Fineness fineness_;
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows_;
    std::vector<double> phase_cotangents_;  // of all phase functions' breakpoints
    PhaseTable phases_;
    ScatterSum sum_;
    double largest_attenuation_ = 0;  // of the uniform water over the bands [1/m]
    double smallest_attenuation_ = 0;
    std::vector<double> largest_per_unit_;  // over the bands, per constituent [1/m per unit]
};

}  // namespace uw
