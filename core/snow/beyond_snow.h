#pragma once

#include <memory>
#include <vector>

#include "core/integrators/integrator.h"

namespace uw {

/// Particles up to a distance are drawn one by one; those beyond are as many as their mean, which
/// this adds to the in-scatter of the water without snow.
class BeyondSnow final : public Integrator {
  public:
    /// A class of particles: drawn up to the distance `range` [m], with this share of the light
    /// that all snow scatters.
    struct Part {
        double range = 0, share = 0;
    };

    /// `water`: of the water without snow; `snow`: of snow alone (core/snow/snow_medium.h).
    BeyondSnow(std::unique_ptr<const Integrator> water, std::unique_ptr<const Integrator> snow,
               std::vector<Part> parts);

    void in_scatter(const Ray& ray, std::span<const double> distances,
                    InScatter& result) const override;
    void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                         InScatter& result) const override;

  private:
    void add_beyond(const Ray& ray, double begin, std::span<const double> distances,
                    InScatter& result) const;

    std::unique_ptr<const Integrator> water_, snow_;
    std::vector<Part> parts_;  // by ascending range
};

}  // namespace uw
