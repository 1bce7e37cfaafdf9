#pragma once

#include <memory>

#include "core/integrators/integrator.h"

namespace uw {

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
