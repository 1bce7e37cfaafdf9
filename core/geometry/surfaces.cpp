#include "core/geometry/surfaces.h"

#include <cassert>
#include <cstddef>

namespace uw {

const SurfaceNames& Surfaces::names() const {
    static const SurfaceNames none;
    return none;
}

void Surfaces::closest_hits(std::span<const Ray> rays, double s_end, std::span<SurfaceHit> hits,
                            std::span<char> found) const {
    assert(hits.size() == rays.size() && found.size() == rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        found[i] = closest_hit(rays[i], s_end, hits[i]) ? 1 : 0;
    }
}

void Surfaces::hit_distances(const Point3& origin, std::span<const Vector3> directions,
                             std::span<double> distances) const {
    assert(distances.size() == directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i) {
        distances[i] = hit_distance({origin, directions[i]});
    }
}

void Surfaces::occluded_many(const Point3& from, std::span<const Point3> to,
                             std::span<char> blocked) const {
    assert(blocked.size() == to.size());
    for (std::size_t i = 0; i < to.size(); ++i) blocked[i] = occluded(from, to[i]) ? 1 : 0;
}

void Surfaces::occluded_many(std::span<const Point3> from, std::span<const Point3> to,
                             std::span<char> blocked) const {
    assert(from.size() == to.size() && blocked.size() == to.size());
    for (std::size_t i = 0; i < to.size(); ++i) blocked[i] = occluded(from[i], to[i]) ? 1 : 0;
}

}  // namespace uw
