#pragma once

#include <memory>

#include "core/base/vector_math.h"
#include "core/light/integrator.h"
#include "core/light/integrator_kind.h"
#include "core/light/lamps_in_view.h"
#include "core/light/medium.h"
#include "core/light/sky_emitter.h"

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
    /// Radiance that each of w.samples scatters to the ray's origin from the light of
    /// an emitter.
    void light_samples(const Ray& ray, std::size_t emitter, Workspace& w) const;

    LitScene scene_;
    LampEvenness evenness_;
    SkyScattering sky_;
    Affine camera_from_world_;
    Slabs slabs_;
    AttenuationTable attenuation_;
};

/// Wraps another integrator and weights the in-scatter of each segment of water by ((Z - F)/Z)^2,
/// where Z is its distance along the ray: the camera's slab-dependent factor in equation (18) of
/// Sedlazeck and Koch 2011. The wrapped integrator is evaluated over slices whose thickness grows
/// from F onwards, independently of any slabs it sums itself, and each slice is weighted at its
/// midpoint: accurate to 0.1 %. Surfaces get their weight from SensorModel::surface_factor.
class FocusWeightedIntegrator final : public Integrator {
  public:
    /// `focal_length` F [m], > 0.
    FocusWeightedIntegrator(std::unique_ptr<const Integrator> integrator, double focal_length);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                         InScatter& result) const override;

  private:
    // `distances` merged with the slice boundaries between `begin` and the last of them, ascending.
    void find_stops(double begin, std::span<const double> distances,
                    std::vector<double>& stops) const;
    // Weights the in-scatter between neighbouring `stops`, given cumulatively in `unweighted`, and
    // sums it up to each of `distances`.
    void weigh(double begin, std::span<const double> stops, const InScatter& unweighted,
               std::span<const double> distances, InScatter& result) const;

    std::unique_ptr<const Integrator> integrator_;
    double focal_length_;
    std::vector<double> faces_;  // of the slices [m], ascending
};

}  // namespace uw
