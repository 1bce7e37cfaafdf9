#pragma once

#include <array>
#include <vector>

#include "core/base/ray.h"
#include "core/paths/lamp_radiance_table.h"
#include "core/paths/next_event_estimator.h"
#include "core/paths/path_segment.h"

namespace uw {

/// The light that lamps throw into the particles of a scene, kept in coarse cells: a plume that is
/// lit up is itself a lamp to all around it, of which no lamp's field tells. It guides paths, so
/// that it may be rough: nothing but their variance depends on it. All values are means over the
/// bands. Thread safe.
class MediumRadianceCache {
  public:
    /// Nothing, where there are no particles. Needs `lamps` only here.
    MediumRadianceCache(const WaterOptics& optics, const LampRadianceTable& field,
                        const NextEventEstimator& lamps);

    bool empty() const { return cells_.empty(); }
    /// The light at a point among the particles, as if it came evenly from all sides, and 0
    /// elsewhere [W m^-2 sr^-1].
    double at(const Point3& x) const;
    /// What they scatter along a ray towards its origin, from up to `reach` [m] [W m^-2 sr^-1].
    double along(const Ray& ray, double reach) const;

  private:
    struct Cell {
        float scattering = 0, attenuation = 0;  // [1/m]
        float light = 0;                        // [W m^-2 sr^-1]
    };

    Bounds bounds_;
    double edge_ = 1;  // of the cells [m]
    std::array<int, 3> count_{};
    std::vector<Cell> cells_;  // x fastest
};

}  // namespace uw
