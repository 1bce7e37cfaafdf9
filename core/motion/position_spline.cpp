#include "core/motion/position_spline.h"

#include "core/motion/knots.h"

namespace uw {

PositionSpline::PositionSpline(const std::vector<double>& knots, const std::vector<Point3>& points)
    : points_(points), bends_(points.size(), Vector3(0.0)) {
    // The tridiagonal system for the bends at inner knots, by elimination; those at the ends are 0.
    const std::size_t count = points.size();
    std::vector<double> above(count, 0.0);
    for (std::size_t i = 1; i + 1 < count; ++i) {
        const double before = knots[i] - knots[i - 1], after = knots[i + 1] - knots[i];
        const double pivot = 2 * (before + after) - before * above[i - 1];
        above[i] = after / pivot;
        const Vector3 turn =
            (points[i + 1] - points[i]) / after - (points[i] - points[i - 1]) / before;
        bends_[i] = (6.0 * turn - before * bends_[i - 1]) / pivot;
    }
    for (std::size_t i = count - 1; i-- > 1;) bends_[i] -= above[i] * bends_[i + 1];
}

Point3 PositionSpline::at(const std::vector<double>& knots, double u) const {
    const KnotSpan span = span_of(knots, u);
    const double b = span.share, a = 1 - b;
    const Vector3 bent =
        (a * a * a - a) * bends_[span.first] + (b * b * b - b) * bends_[span.first + 1];
    const Point3 straight =
        points_[span.first] + b * (points_[span.first + 1] - points_[span.first]);
    return straight + span.width * span.width / 6 * bent;
}

Vector3 PositionSpline::velocity(const std::vector<double>& knots, double u) const {
    const KnotSpan span = span_of(knots, u);
    const double b = span.share, a = 1 - b;
    const Vector3 bent =
        (3 * b * b - 1) * bends_[span.first + 1] - (3 * a * a - 1) * bends_[span.first];
    return (points_[span.first + 1] - points_[span.first]) / span.width + span.width / 6 * bent;
}

}  // namespace uw
