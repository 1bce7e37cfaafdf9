#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/ray.h"
#include "core/base/vector_math.h"

namespace uw {

/// The geometry of a camera ray passing one lamp, or through the parallel light of a sun
/// (Emitter::passage).
struct LampPassage {
    double foot = 0;      // distance along the ray of the point nearest to the lamp [m]; may be < 0
    double distance = 0;  // from that point to the lamp [m], with Emitter::squared_offset
    // Members for a sun, which the ray does not pass:
    bool parallel = false;
    double begin_length = 0;  // of the path of the light to the ray's origin [m]
    double slope = 0;         // change of that length per metre along the ray
    double tangent = 0;       // half_tangent

    LampPassage() = default;
    LampPassage(const Ray& ray, const Point3& lamp) {
        const Vector3 to_lamp = lamp - ray.origin;
        foot = glm::dot(to_lamp, ray.direction);
        distance = glm::length(to_lamp - foot * ray.direction);
    }

    /// The distance that the light has travelled to the point at `s` (from Emitter::origin) [m].
    double radius(double s) const {
        if (parallel) return begin_length + slope * s;
        return std::sqrt((s - foot) * (s - foot) + distance * distance);
    }
    /// The distance along the ray beyond which the path of the light, to the ray and back along it
    /// to the camera, exceeds the shortest such path by at least `more` [m].
    double max_distance(double more) const { return std::max(0.0, radius(0)) + more; }
    /// The greatest change of that path's length per metre.
    double rate() const { return parallel ? std::abs(1 + slope) : 2; }
    /// tan(psi / 2) at `s`, whose distance from the lamp is `radius`, where psi is the scattering
    /// angle for light from the lamp to the ray's origin (physics section 2). On a ray through the
    /// lamp it is infinite beyond the lamp and 0 before it.
    double half_tangent(double s, double radius) const {
        if (parallel) return tangent;
        const double to_foot = foot - s;
        return to_foot > 0 ? distance / (radius + to_foot) : (radius - to_foot) / distance;
    }
};

}  // namespace uw
