#pragma once

#include <cmath>
#include <vector>

#include "core/base/ray.h"
#include "core/lamps/lamp.h"

namespace uw {

/// The geometry of a camera ray passing one lamp.
struct LampPassage {
    double foot = 0;      // distance along the ray of the point nearest to the lamp [m]; may be < 0
    double distance = 0;  // from that point to the lamp [m]

    LampPassage(const Ray& ray, const Point3& lamp);

    /// Distance from the lamp to the point at `s`.
    double radius(double s) const {
        return std::sqrt((s - foot) * (s - foot) + distance * distance);
    }
    /// tan(psi / 2) at `s`, whose distance from the lamp is `radius`, where psi is the scattering
    /// angle for light from the lamp to the ray's origin (physics section 2). On a ray through the
    /// lamp it is infinite beyond the lamp and 0 before it.
    double half_tangent(double s, double radius) const {
        const double to_foot = foot - s;
        return to_foot > 0 ? distance / (radius + to_foot) : (radius - to_foot) / distance;
    }
};

/// Appends the distances in (begin, end) at which the single-scattering integrand changes its
/// scale, so that a Gauss rule with few nodes is accurate to 1e-5 between neighbours: octaves of
/// the distance from the foot, on which 1/r^2 and the forward peak of a phase function are power
/// laws.
void append_octaves(const LampPassage& passage, const Interval& interval, std::vector<double>& s);

}  // namespace uw
