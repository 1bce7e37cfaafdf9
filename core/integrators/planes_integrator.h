#pragma once

#include "core/base/affine.h"
#include "core/integrators/integrator_kind.h"
#include "core/optics/optical_depth.h"

namespace uw {

/// McGlamery's sum over slabs parallel to the image plane, as the paper writes it (Sedlazeck and
/// Koch 2011, equations 17 and 18, without its camera terms), for uniform water:
///
///     L_b = sum_i e^(-c s_i) E_s(X_i) dz_i / cos(theta),
///     E_s(X) = sum_j V_j(X) I_j e^(-c R_j) / R_j^2 beta(psi_j)
///
/// X_i is where the water ray crosses the middle of slab i, s_i its distance from the outer glass
/// surface, theta the ray's angle to the optical axis, R_j the distance of lamp j. A slab that the
/// glass or a surface cuts counts with the part that is left, taken at the middle of that part. The
/// error falls with the square of the slabs' thickness where the lamps light the ray smoothly, and
/// with the thickness itself at shadow and beam edges. Shares no integration code with the other
/// integrators.
class PlanesIntegrator final : public Integrator {
  public:
    /// For uniform water, in cameras that see less than a hemisphere.
    static const IntegratorKind k_kind;

    /// `slabs` lie in the camera that `world_from_camera` places; water outside them counts for
    /// nothing. Throws InputError if `scene` has constituents that vary in space.
    PlanesIntegrator(const LitScene& scene, const Affine& world_from_camera, const Slabs& slabs);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                         InScatter& result) const override;

  private:
    /// A slab's stretch of a ray, or what a distance within it cuts off.
    struct Sample {
        double s;              // middle, along the ray [m]
        double length;         // dz / cos(theta) [m]
        std::size_t distance;  // index of the first distance that it counts for
        bool cut;              // counts for this one only, else for all from it on
    };
    struct Workspace;

    void place_samples(const Ray& ray, double begin, std::span<const double> distances,
                       std::vector<Sample>& samples) const;
    /// Radiance that each of w.samples sends to the ray's origin by the light of `lamp`.
    void light_samples(const Ray& ray, const Lamp& lamp, Workspace& w) const;

    LitScene scene_;
    Affine camera_from_world_;
    Slabs slabs_;
    AttenuationTable attenuation_;
};

}  // namespace uw
