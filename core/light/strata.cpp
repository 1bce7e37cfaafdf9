#include "core/light/strata.h"

#include <algorithm>
#include <cmath>

namespace uw {

std::size_t Strata::interval(double depth) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(depths_, depth) - depths_.begin());
}

double Strata::value(const Curve& curve, double depth, std::size_t interval) const {
    if (interval == 0) return curve.values.front();
    if (interval == depths_.size()) return curve.values.back();
    const double t = (depth - depths_[interval - 1]) / (depths_[interval] - depths_[interval - 1]);
    return std::lerp(curve.values[interval - 1], curve.values[interval], std::clamp(t, 0.0, 1.0));
}

void Strata::add_sample(const Point3& x, std::span<double> concentration) const {
    const double at = depth(x);
    const std::size_t i = interval(at);
    for (const Curve& curve : curves_) concentration[curve.constituent] += value(curve, at, i);
}

void Strata::add_column(const Point3& a, const Point3& b, std::span<double> column) const {
    const double above_a = glm::dot(a - surface_, up_), above_b = glm::dot(b - surface_, up_);
    if (is_mirror_ && above_a * above_b < 0) {
        const Point3 middle = a + above_a / (above_a - above_b) * (b - a);
        add_straight_column(a, middle, column);
        add_straight_column(middle, b, column);
    } else {
        add_straight_column(a, b, column);
    }
}

// Sums over the table's intervals, in each of which concentrations are linear, so that the mean of
// the values at both ends is exact: no difference of large integrals loses digits, however level
// the path is.
void Strata::add_straight_column(const Point3& a, const Point3& b, std::span<double> column) const {
    const double from = std::min(depth(a), depth(b)), to = std::max(depth(a), depth(b));
    const double length = distance(a, b);
    const auto add = [&](double first, double last, std::size_t i) {
        const double fraction = to > from ? (last - first) / (to - from) : 1;
        for (const Curve& curve : curves_)
            column[curve.constituent] +=
                0.5 * fraction * length * (value(curve, first, i) + value(curve, last, i));
    };
    std::size_t i = interval(from);
    double first = from;
    for (; i < depths_.size() && depths_[i] < to; ++i) {
        add(first, depths_[i], i);
        first = depths_[i];
    }
    add(first, to, i);
}

void Strata::append_breaks(const Ray& ray, double s_end, std::vector<double>& s) const {
    const double begin = -glm::dot(ray.origin - surface_, up_);
    const double rate = -glm::dot(ray.direction, up_);
    if (rate == 0) return;
    const auto add = [&](double of) {
        const double at = (of - begin) / rate;
        if (at > 0 && at < s_end) s.push_back(at);
    };
    if (rate > 0)
        std::for_each(depths_.begin(), depths_.end(), add);
    else
        std::for_each(depths_.rbegin(), depths_.rend(), add);
}

}  // namespace uw
