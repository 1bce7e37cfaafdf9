#include "core/lamps/direction_cone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {

DirectionCone DirectionCone::widened(double angle) const {
    const double wide = std::acos(std::max(-1.0, cosine)) + angle;
    return {axis, wide < std::numbers::pi ? std::cos(wide) : -1.0};
}

bool DirectionCone::includes(const DirectionCone& other) const {
    if (has_all() || other.has_all()) return has_all();
    const double apart =
        std::atan2(glm::length(glm::cross(axis, other.axis)), glm::dot(axis, other.axis));
    return apart + std::acos(other.cosine) <= std::acos(cosine) + 1e-12;
}

}  // namespace uw
