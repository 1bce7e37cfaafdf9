#pragma once

#include "core/base/vector_math.h"
#include "core/scene/scene_context.h"

namespace uw {

/// Parallel light that enters the water through its plane surface. There is none above.
struct Sunlight {
    Vector3 direction{0, -1, 0};  // of travel in the water, world, unit; downwards
    WaterSurfaceDesc surface;

    /// The light of a sun that travels in this direction (unit) in the air, refracted by Snell's
    /// law if the surface has an index; otherwise directions are given in the water.
    static Sunlight from_air(const Vector3& direction, const WaterSurfaceDesc& surface);

    /// The length of its path through the water to `x` [m]; negative above the surface.
    double length_to(const Point3& x) const {
        return glm::dot(surface.normal, x - surface.point) / per_metre();
    }
    /// How much that length grows per metre along a unit vector.
    double slope(const Vector3& v) const { return glm::dot(surface.normal, v) / per_metre(); }
    /// The point at which the light that reaches `x` enters the water.
    Point3 entry(const Point3& x) const { return x - length_to(x) * direction; }

    friend bool operator==(const Sunlight&, const Sunlight&) = default;

  private:
    double per_metre() const { return glm::dot(surface.normal, direction); }  // < 0
};

}  // namespace uw
