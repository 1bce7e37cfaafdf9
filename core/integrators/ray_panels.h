#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/ray.h"
#include "core/lamps/lamp.h"

namespace uw {

/// The geometry of a camera ray passing one lamp, or through the parallel light of a sun.
struct LampPassage {
    double foot = 0;      // distance along the ray of the point nearest to the lamp [m]; may be < 0
    double distance = 0;  // from that point to the lamp [m]
    // Of a sun, which the ray does not pass:
    bool parallel = false;
    double begin_length = 0;  // of the way of the light to the ray's origin [m]
    double slope = 0;         // by how much it grows per metre
    double tangent = 0;       // half_tangent

    LampPassage() = default;
    LampPassage(const Ray& ray, const Point3& lamp);
    LampPassage(const Ray& ray, const Lamp& lamp);

    /// Distance that the light has come to the point at `s` (Lamp::origin).
    double radius(double s) const {
        if (parallel) return begin_length + slope * s;
        return std::sqrt((s - foot) * (s - foot) + distance * distance);
    }
    /// The distance along the ray beyond which the way of the light, to the ray and back along it,
    /// is longer than it is anywhere by at least `more`.
    double reach(double more) const { return std::max(0.0, radius(0)) + more; }
    /// The greatest change of that way per metre.
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

/// Appends the distances in (begin, end) at which the single-scattering integrand changes its
/// scale, so that a Gauss rule with few nodes is accurate to 1e-5 between neighbours: octaves of
/// the distance from the foot, on which 1/r^2 and the forward peak of a phase function are power
/// laws. None for a sun.
void append_octaves(const LampPassage& passage, const Interval& interval, std::vector<double>& s);

/// The interval of `ray` inside `bounds`, up to k_far; empty (begin > end) if it misses them.
Interval inside(const Ray& ray, const Bounds& bounds);

}  // namespace uw
