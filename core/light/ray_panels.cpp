#include "core/light/ray_panels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/light/integrator.h"

namespace uw {

namespace {

constexpr std::size_t k_usual_breaks = 64;  // so that memory is allocated once for most rays

}  // namespace

void append_octaves(const LampPassage& passage, const Interval& interval, std::vector<double>& s) {
    if (passage.parallel) return;
    const auto append = [&](double at) {
        if (at > interval.begin && at < interval.end) s.push_back(at);
    };
    append(passage.foot);
    const double max_offset =
        std::max(std::abs(interval.begin - passage.foot), std::abs(interval.end - passage.foot));
    for (double u = 0.75 * std::max(passage.distance, k_lamp_radius); u < max_offset; u *= 2) {
        append(passage.foot - u);
        append(passage.foot + u);
    }
}

Interval inside(const Ray& ray, const Bounds& bounds) {
    Interval interval{0, k_far};
    if (bounds.empty()) return {1, 0};
    for (int axis = 0; axis < 3; ++axis) {
        const double d = ray.direction[axis];
        const double to_min = bounds.min[axis] - ray.origin[axis];
        const double to_max = bounds.max[axis] - ray.origin[axis];
        if (d == 0 && (to_min > 0 || to_max < 0)) return {1, 0};
        if (d == 0) continue;
        interval.begin = std::max(interval.begin, std::min(to_min / d, to_max / d));
        interval.end = std::min(interval.end, std::max(to_min / d, to_max / d));
    }
    return interval;
}

void PanelBreaks::reset(const Interval& interval) {
    interval_ = interval;
    candidates_.clear();
    candidates_.reserve(k_usual_breaks);
}

const std::vector<double>& PanelBreaks::kept() {
    std::sort(candidates_.begin(), candidates_.end(),
              [](const Candidate& a, const Candidate& b) { return a.s < b.s; });
    candidates_.push_back({interval_.end, 0});
    kept_.reserve(candidates_.size() + 1);
    kept_.assign(1, interval_.begin);
    double spacing_of_last = 0;
    for (const Candidate& candidate : candidates_) {
        const double since_last = candidate.s - kept_.back();
        if (since_last < candidate.spacing) continue;
        // An edge replaces a mark just before it.
        if (candidate.spacing == 0 && since_last < spacing_of_last) kept_.pop_back();
        kept_.push_back(candidate.s);
        spacing_of_last = candidate.spacing;
    }
    return kept_;
}

}  // namespace uw
