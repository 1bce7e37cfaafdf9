#pragma once

#include <array>
#include <vector>

#include "core/base/ray.h"
#include "core/paths/emission_sampler.h"
#include "core/paths/lamp_radiance_table.h"
#include "core/paths/next_event_estimator.h"
#include "core/paths/path_segment.h"

namespace uw {

/// A coarse radiance cache in the medium: the mean radiance of lamp light in cells of the particle
/// field, for guiding. A plume that is lit illuminates what is around it, which no
/// LampRadianceTable knows. Only the variance of paths depends on it. All values are means over the
/// bands. Thread safe.
class MediumRadianceCache {
  public:
    /// Remains empty without particles. Uses `lamps` only during construction.
    MediumRadianceCache(const WaterOptics& optics, const LampRadianceTable& field,
                        const NextEventEstimator& lamps, const EmissionSampler& emission);

    bool empty() const { return cells_.empty(); }
    /// The mean radiance over all directions at a point within the particle field; 0 elsewhere [W
    /// m^-2 sr^-1].
    double at(const Point3& x) const;
    /// The radiance that particles scatter along a ray towards its origin, from distances up to
    /// `max_distance` [m] [W m^-2 sr^-1].
    double along(const Ray& ray, double max_distance) const;

  private:
    struct Cell {
        float scattering = 0, attenuation = 0;  // [1/m]
        float light = 0;                        // [W m^-2 sr^-1]
    };

    /// The cell at a place [cells]; the nearest to one outside.
    std::size_t index_of(const Vector3& place) const;

    Bounds bounds_;
    double edge_ = 1;  // of the cells [m]
    std::array<int, 3> count_{};
    std::vector<Cell> cells_;  // x fastest
};

}  // namespace uw
