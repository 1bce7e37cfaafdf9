#pragma once

#include "core/base/vec.h"

namespace uw {

/// The directions within an angle of an axis.
struct DirectionCone {
    Vector3 axis{0, 0, 1};  // unit
    double cosine = -1;     // of the angle; -1: all directions

    bool has_all() const { return cosine <= -1; }
    /// `direction`: of any length.
    bool has(const Vector3& direction) const {
        if (has_all()) return true;  // regardless of rounding
        const double along = glm::dot(direction, axis);
        const double edge = cosine * cosine * glm::dot(direction, direction);  // of along^2
        return cosine >= 0 ? along >= 0 && along * along >= edge
                           : along >= 0 || along * along <= edge;
    }
    /// All directions within `angle` [rad] of a direction in this cone.
    DirectionCone widened(double angle) const;
    bool includes(const DirectionCone& other) const;
};

}  // namespace uw
