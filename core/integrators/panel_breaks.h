#pragma once

#include <vector>

#include "core/base/ray.h"

namespace uw {

/// Collects the distances along a ray at which quadrature panels begin and end, and drops those
/// that follow their predecessor too closely. Reused between rays.
class PanelBreaks {
  public:
    /// Restarts for the interval `stretch`; breaks added outside it are ignored.
    void reset(const Interval& stretch);

    /// The integrand has a jump or kink here, or its integral up to here is needed: always kept.
    void add_edge(double s) { add_mark(s, 0); }
    /// The integrand merely changes its scale here: dropped if another break lies within `spacing`
    /// [m, > 0] before it, or an edge within `spacing` after it.
    void add_mark(double s, double spacing) {
        if (s > stretch_.begin && s < stretch_.end) candidates_.push_back({s, spacing});
    }

    /// Both ends of the interval and the breaks kept between them, ascending. Valid until the next
    /// call.
    const std::vector<double>& kept();

  private:
    struct Candidate {
        double s;
        double spacing;  // 0: an edge
    };

    Interval stretch_;
    std::vector<Candidate> candidates_;
    std::vector<double> kept_;
};

}  // namespace uw
