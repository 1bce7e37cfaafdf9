#pragma once

#include "core/base/vec.h"

namespace uw {

/// A half-line; `direction` is unit, so that the parameter of `at` is in metres.
struct Ray {
    Point3 origin;
    Vector3 direction{0, 0, 1};

    Point3 at(double s) const { return origin + s * direction; }
};

/// An interval [begin, end] along a ray, in metres from its origin.
struct Interval {
    double begin = 0;
    double end = 0;

    double length() const { return end - begin; }
};

/// An axis-aligned bounding box in the space that its owner specifies; empty while min > max.
struct Bounds {
    Point3 min{1e300, 1e300, 1e300};
    Point3 max{-1e300, -1e300, -1e300};

    bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
    void extend(const Point3& p) {
        for (int axis = 0; axis < 3; ++axis) {
            min[axis] = glm::min(min[axis], p[axis]);
            max[axis] = glm::max(max[axis], p[axis]);
        }
    }
    void extend(const Bounds& b) {
        if (!b.empty()) {
            extend(b.min);
            extend(b.max);
        }
    }
    Point3 center() const { return min + 0.5 * (max - min); }
    double diagonal() const { return empty() ? 0.0 : glm::length(max - min); }
};

}  // namespace uw
