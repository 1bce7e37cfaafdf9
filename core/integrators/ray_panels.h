#pragma once

#include <cmath>
#include <vector>

#include "core/base/ray.h"
#include "core/lamps/lamp.h"

namespace uw {

/// How a camera ray passes one lamp.
struct LampPassage {
    double foot = 0;      // distance along the ray of the point nearest to the lamp [m]; may be < 0
    double distance = 0;  // of that point from the lamp [m]

    LampPassage(const Ray& ray, const Point3& lamp);

    /// Distance from the lamp of the point at `s`.
    double radius(double s) const {
        return std::sqrt((s - foot) * (s - foot) + distance * distance);
    }
    /// tan(psi / 2) at `s`, whose distance from the lamp is `radius`, with psi the scattering angle
    /// for light from the lamp to the ray's origin (physics section 2): infinite beyond the lamp,
    /// 0 well before it.
    double half_tangent(double s, double radius) const {
        const double to_foot = foot - s;
        return to_foot > 0 ? distance / (radius + to_foot) : (radius - to_foot) / distance;
    }
};

/// Appends the distances in (begin, end) at which the integrand of single scattering changes its
/// scale, so that a Gauss rule of few nodes is exact to 1e-5 between neighbours: octaves of the
/// distance from the foot, on which 1/r^2 and the forward peak of a phase function are power laws.
void append_octaves(const LampPassage& passage, const Interval& interval, std::vector<double>& s);

}  // namespace uw
