#pragma once

#include <memory>

#include "core/integrators/integrator.h"

namespace uw {

/// Another integrator's in-scatter with each stretch of water weighted by ((Z - F)/Z)^2, Z its
/// distance along the ray: the camera's part of equation (18) of Sedlazeck and Koch 2011 that
/// depends on the slab. The other is asked for its in-scatter in slices that grow from F on,
/// whatever slabs it sums itself, and each slice is weighted by its middle: exact to 0.1 %.
/// Surfaces have their weight from SensorModel::surface_factor.
class FocusWeightedIntegrator final : public Integrator {
  public:
    /// `focal_length` F [m], > 0.
    FocusWeightedIntegrator(std::unique_ptr<const Integrator> integrator, double focal_length);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                         InScatter& result) const override;

  private:
    // The distances and the slices' faces between `begin` and the last of them, ascending.
    void find_stops(double begin, std::span<const double> distances,
                    std::vector<double>& stops) const;
    // Weights what lies between neighbouring `stops`, up to which `unweighted` holds the
    // in-scatter, and sums it up to each of `distances`.
    void weigh(double begin, std::span<const double> stops, const InScatter& unweighted,
               std::span<const double> distances, InScatter& result) const;

    std::unique_ptr<const Integrator> integrator_;
    double focal_length_;
    std::vector<double> faces_;  // of the slices [m], ascending
};

}  // namespace uw
