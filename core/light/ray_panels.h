#pragma once

#include <vector>

#include "core/base/ray.h"
#include "core/light/lamp_passage.h"

namespace uw {

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
