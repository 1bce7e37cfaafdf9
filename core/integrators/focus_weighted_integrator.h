#pragma once

#include <memory>

#include "core/integrators/integrator.h"

namespace uw {

/// Another integrator's in-scatter with each stretch of water weighted by ((Z - F)/Z)^2, Z its
/// distance along the ray: the camera's part of equation (18) of Sedlazeck and Koch 2011 that
/// depends on the slab. It asks the other for its in-scatter in slices that grow from F on,
/// whatever slabs it sums itself, and weights each by its middle: exact to 0.1 %.
class FocusWeightedIntegrator final : public Integrator {
  public:
    /// `focal_length` F [m], > 0.
    FocusWeightedIntegrator(std::unique_ptr<Integrator> integrator, double focal_length);

    void in_scatter(const Ray& ray, std::span<const double> ends, InScatter& result) const override;
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> ends,
                         InScatter& result) const override;
    /// The other integrator's, unweighted: see SensorModel::surface_factor.
    void surface_lights(std::span<const SurfaceSample* const> samples,
                        SurfaceLight& light) const override;

  private:
    // The ends and the slices' faces between `begin` and the last of them, ascending.
    void find_stops(double begin, std::span<const double> ends, std::vector<double>& stops) const;
    // Sums what `unweighted` holds up to each of `stops`, weighted, up to each of `ends`.
    void weigh(double begin, std::span<const double> stops, const InScatter& unweighted,
               std::span<const double> ends, InScatter& result) const;

    std::unique_ptr<Integrator> integrator_;
    double focal_length_;
    std::vector<double> faces_;  // of the slices [m], ascending
};

}  // namespace uw
