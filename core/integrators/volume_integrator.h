#pragma once

#include <memory>
#include <vector>

#include "core/integrators/deep_shadow.h"
#include "core/integrators/integrator.h"
#include "core/integrators/lit_scene.h"
#include "core/integrators/panel_breaks.h"
#include "core/integrators/ray_panels.h"
#include "core/integrators/scatter_nodes.h"

namespace uw {

/// How finely VolumeIntegrator follows what varies from voxel to voxel.
struct VolumeQuadrature {
    int voxels_per_panel = 2;  // two nodes each; many are for drafts
    /// Of the columns between surfaces, camera and lamps (ColumnMixing).
    double column_tolerance = 0;
};

/// Deterministic quadrature of single scattering (physics section 5) on light splatted ahead of
/// time: Gauss rules on panels that follow the lamp's octaves, the phase functions' breakpoints,
/// lit intervals, voxels and the lamp's columns.
class VolumeIntegrator : public Integrator {
  public:
    /// `deep_shadows`: one per lamp of `scene`.
    VolumeIntegrator(const LitScene& scene,
                     std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                     const VolumeQuadrature& quadrature = {});

    void in_scatter(const Ray& ray, std::span<const double> ends, InScatter& result) const override;
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> ends,
                         InScatter& result) const override;
    void surface_lights(std::span<const SurfaceSample* const> samples,
                        SurfaceLight& light) const override;

  private:
    struct Workspace;

    // Where panels begin and end within a lit interval of lamp `lamp`, ascending.
    const std::vector<double>& find_breaks(const Ray& ray, std::size_t lamp,
                                           const LampPassage& passage, const Interval& interval,
                                           std::span<const double> ends, Workspace& w) const;
    void add_panels(const Ray& ray, std::size_t lamp, const LampPassage& passage,
                    std::span<const double> ends, std::span<const double> breaks,
                    const ConcentrationProfile& profile, ScatterNodes& nodes) const;

    LitScene scene_;
    VolumeQuadrature quadrature_;
    std::vector<std::shared_ptr<const DeepShadow>> deep_shadows_;
    std::vector<double> phase_cotangents_;  // of all phase functions' breakpoints
    PhaseTable phases_;
    ScatterSum sum_;
    double largest_attenuation_ = 0;  // of the uniform water over the bands [1/m]
    double smallest_attenuation_ = 0;
    std::vector<double> largest_per_unit_;  // over the bands, per constituent [1/m per unit]
};

}  // namespace uw
