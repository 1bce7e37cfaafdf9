#pragma once

#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"

namespace uw {

/// In-scattered radiance [W m^-2 sr^-1] up to each of several distances along one ray, by lamp.
class InScatter {
  public:
    /// Resets to zero for the given numbers of distances and lamps.
    void reset(std::size_t distances, std::size_t lamps) {
        lamps_ = lamps;
        values_.assign(distances * lamps, Spectrum{});
    }
    std::size_t lamp_count() const { return lamps_; }
    /// In-scatter up to the distance with index `distance`, due to the lamp with index `lamp`.
    Spectrum& at(std::size_t distance, std::size_t lamp) {
        return values_[distance * lamps_ + lamp];
    }
    const Spectrum& at(std::size_t distance, std::size_t lamp) const {
        return values_[distance * lamps_ + lamp];
    }

  private:
    std::size_t lamps_ = 0;
    std::vector<Spectrum> values_;
};

/// Single scattering along camera rays (physics section 5). Thread safe.
class Integrator {
  public:
    virtual ~Integrator() = default;

    /// The radiance that the water between the ray's origin and each of `distances` scatters
    /// towards the origin, for each lamp. `distances` [m] ascend; the last may be k_far, for a ray
    /// that hits nothing.
    virtual void in_scatter(const Ray& ray, std::span<const double> distances,
                            InScatter& result) const = 0;

    /// The same for the water between `begin` [m] and each of `distances`, all of which lie beyond
    /// `begin`. The default takes the difference of in_scatter at the two ends; integrators that
    /// can skip the water before `begin` override it.
    virtual void in_scatter_from(const Ray& ray, double begin, std::span<const double> distances,
                                 InScatter& result) const;
};

/// Denotes "no surface": no lamp's light returns from beyond this distance [m].
inline constexpr double k_far = 1e4;

}  // namespace uw
