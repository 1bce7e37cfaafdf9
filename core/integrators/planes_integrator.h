#pragma once

#include "core/base/affine.h"
#include "core/integrators/integrator_kind.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// McGlamery's sum over slabs parallel to the image plane, as formulated in the paper (Sedlazeck
/// and Koch 2011, equations 17 and 18, without its camera terms), for uniform water:
///
///     L_b = sum_i e^(-c s_i) E_s(X_i) dz_i / cos(theta),
///     E_s(X) = sum_j V_j(X) I_j e^(-c R_j) / R_j^2 beta(psi_j)
///
/// X_i is where the water ray crosses the mid-plane of slab i, s_i its distance from the outer
/// glass surface, theta the ray's angle to the optical axis, R_j the distance from lamp j. A slab
/// cut by the glass or a surface contributes its remaining part, sampled at the midpoint of that
/// part. The error is second order in the slab thickness where the lamps illuminate the ray
/// smoothly, and first order at shadow and beam edges. Shares no integration code with the other
/// integrators.
class PlanesIntegrator final : public Integrator {
  public:
    /// For uniform water and cameras whose field of view is less than a hemisphere.
    static const IntegratorKind k_kind;

    /// `slabs` are given in the frame of the camera that `world_from_camera` places; water outside
    /// them is ignored. Throws InputError if `scene` has constituents that vary in space.
    PlanesIntegrator(const LitScene& scene, const Affine& world_from_camera, const Slabs& slabs);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                         InScatter& result) const override;

  private:
    /// The segment of a ray inside a slab, or the part of it before a distance that lies within.
    struct Sample {
        double s;              // midpoint, along the ray [m]
        double length;         // dz / cos(theta) [m]
        std::size_t distance;  // index of the first distance that it contributes to
        bool cut;              // contributes to this distance only, else to all from it on
    };
    struct Workspace;

    void place_samples(const Ray& ray, double begin, std::span<const double> distances,
                       std::vector<Sample>& samples) const;
    /// Radiance that each of w.samples scatters to the ray's origin from the light of `lamp`.
    void light_samples(const Ray& ray, const Lamp& lamp, Workspace& w) const;

    LitScene scene_;
    Affine camera_from_world_;
    Slabs slabs_;
    AttenuationTable attenuation_;
};

}  // namespace uw
