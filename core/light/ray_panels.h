#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/ray.h"
#include "core/light/lamp.h"

namespace uw {

/// The geometry of a camera ray passing one lamp, or through the parallel light of a sun.
struct LampPassage {
    double foot = 0;      // distance along the ray of the point nearest to the lamp [m]; may be < 0
    double distance = 0;  // from that point to the lamp [m], with Lamp::squared_offset
    // Members for a sun, which the ray does not pass:
    bool parallel = false;
    double begin_length = 0;  // of the path of the light to the ray's origin [m]
    double slope = 0;         // change of that length per metre along the ray
    double tangent = 0;       // half_tangent

    LampPassage() = default;
    LampPassage(const Ray& ray, const Point3& lamp);
    LampPassage(const Ray& ray, const Lamp& lamp);

    /// The distance that the light has travelled to the point at `s` (from Lamp::origin) [m].
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

/// Appends the distances in (begin, end) at which the single-scattering integrand changes its
/// scale, so that a Gauss rule with few nodes is accurate to 1e-5 between neighbours: octaves of
/// the distance from the foot, on which 1/r^2 and the forward peak of a phase function are power
/// laws. None for a sun.
void append_octaves(const LampPassage& passage, const Interval& interval, std::vector<double>& s);

/// The interval of `ray` inside `bounds`, up to k_far; empty (begin > end) if it misses them.
Interval inside(const Ray& ray, const Bounds& bounds);

/// Collects the distances along a ray at which quadrature panels begin and end, and drops those
/// that follow their predecessor too closely. Reused between rays.
class PanelBreaks {
  public:
    /// Restarts for the interval `interval`; breaks added outside it are ignored.
    void reset(const Interval& interval);

    /// The integrand has a jump or kink here, or its integral up to here is needed: always kept.
    void add_edge(double s) { add_mark(s, 0); }
    /// The integrand merely changes its scale here: dropped if another break lies within `spacing`
    /// [m, > 0] before it, or an edge within `spacing` after it.
    void add_mark(double s, double spacing) {
        if (s > interval_.begin && s < interval_.end) candidates_.push_back({s, spacing});
    }

    /// Both ends of the interval and the breaks kept between them, ascending. Valid until the next
    /// call.
    const std::vector<double>& kept();

  private:
    struct Candidate {
        double s;
        double spacing;  // 0: an edge
    };

    Interval interval_;
    std::vector<Candidate> candidates_;
    std::vector<double> kept_;
};

}  // namespace uw
