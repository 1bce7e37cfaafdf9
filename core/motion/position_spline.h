#pragma once

#include <vector>

#include "core/base/vec.h"

namespace uw {

/// A smooth curve through points: the natural cubic spline over the knots, continuous up to its
/// second derivative (de Boor, A Practical Guide to Splines, 1978, chapter IV).
class PositionSpline {
  public:
    /// `knots`: strictly ascending, at least two, one per point.
    PositionSpline(const std::vector<double>& knots, const std::vector<Point3>& points);

    Point3 at(const std::vector<double>& knots, double u) const;
    /// The derivative of the position by the knots' parameter.
    Vector3 velocity(const std::vector<double>& knots, double u) const;

  private:
    std::vector<Point3> points_;
    std::vector<Vector3> bends_;  // second derivatives at the knots
};

}  // namespace uw
