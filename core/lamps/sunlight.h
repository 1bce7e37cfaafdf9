#pragma once

#include "core/base/vec.h"
#include "core/scene/water_surface_desc.h"

namespace uw {

/// Parallel light that enters the water through its plane surface. There is none above.
struct Sunlight {
    Vector3 direction{0, -1, 0};  // in which it travels in the water, world, unit; downwards
    WaterSurfaceDesc surface;

    /// How far it has come through the water at `x` [m]; negative above the surface.
    double length_to(const Point3& x) const {
        return glm::dot(surface.normal, x - surface.point) / per_metre();
    }
    /// How much that length grows per metre along a unit vector.
    double slope(const Vector3& v) const { return glm::dot(surface.normal, v) / per_metre(); }
    /// Where the light that reaches `x` enters the water.
    Point3 entry(const Point3& x) const { return x - length_to(x) * direction; }

    friend bool operator==(const Sunlight&, const Sunlight&) = default;

  private:
    double per_metre() const { return glm::dot(surface.normal, direction); }  // < 0
};

}  // namespace uw
