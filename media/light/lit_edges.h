#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/surfaces/surfaces.h"

namespace uw {

/// Collects the lit intervals of a stretch of a ray, in ascending order, and finds edges of shadows
/// that a shadow map cannot decide by exact shadow rays. `Origin` tells where the light that
/// reaches a point comes from.
template <class Origin>
class LitEdges {
  public:
    /// What is referred to must outlive this object.
    LitEdges(const Surfaces& surfaces, Origin origin, const Ray& ray, std::vector<Interval>& lit)
        : surfaces_(surfaces), origin_(origin), ray_(ray), lit_(lit) {}

    /// Of what follows, up to the next call.
    void set_stretch(const Interval& stretch) { stretch_ = stretch; }

    void append(const Interval& interval) {
        if (!lit_.empty() && lit_.back().end == interval.begin)
            lit_.back().end = interval.end;
        else
            lit_.push_back(interval);
    }

    /// Appends the lit part of an interval with at most one edge, which is found to within `width`
    /// [m].
    void resolve(double begin, double end, double width) {
        const bool lit_at_begin = visible_at_end(begin, end);
        const bool lit_at_end = visible_at_end(end, begin);
        if (lit_at_begin == lit_at_end) {
            if (lit_at_begin) append({begin, end});
            return;
        }
        double a = begin, b = end;
        while (b - a > width) {
            const double middle = 0.5 * (a + b);
            (visible(middle) == lit_at_begin ? a : b) = middle;
        }
        const double edge = 0.5 * (a + b);
        append(lit_at_begin ? Interval{begin, edge} : Interval{edge, end});
    }

  private:
    bool visible(double s) const {
        const Point3 x = ray_.at(s);
        return !surfaces_.occluded(origin_(x), x);
    }

    // Visibility at the end of an interval; slightly inside it at the ends of the whole stretch,
    // which may lie on a surface, since a surface occludes nothing within 1e-5 of the distance
    // (Surfaces::occluded).
    bool visible_at_end(double s, double into) {
        if (s == last_seen_.s) return last_seen_.visible;
        const bool is_end = s == stretch_.begin || s == stretch_.end;
        const Point3 x = ray_.at(s);
        const double inset = std::min(0.25 * std::abs(into - s), 3e-5 * distance(origin_(x), x));
        last_seen_ = {s, visible(is_end ? s + std::copysign(inset, into - s) : s)};
        return last_seen_.visible;
    }

    // Neighbouring intervals share an end.
    struct Seen {
        double s = -1;
        bool visible = false;
    };

    const Surfaces& surfaces_;
    Origin origin_;
    const Ray& ray_;
    Interval stretch_;
    std::vector<Interval>& lit_;
    Seen last_seen_;
};

}  // namespace uw
