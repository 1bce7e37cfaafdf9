#include "core/geometry/water_surface.h"

#include <cmath>

#include "core/base/refraction.h"

namespace uw {

double WaterSurface::critical_cosine() const {
    return std::sqrt(1 - 1 / (n_ * n_));
}

Point3 WaterSurface::between(const Point3& a, const Point3& b) const {
    const double from = height(a), to = height(b);
    return a + from / (from - to) * (b - a);
}

std::optional<double> WaterSurface::crossing(const Ray& ray) const {
    const double rise = glm::dot(ray.direction, up_);
    if (!(rise > 0)) return std::nullopt;
    const double distance = -height(ray.origin) / rise;
    return distance > 0 ? std::optional(distance) : std::nullopt;
}

double WaterSurface::reflectance_from_water(double cosine) const {
    return 1 - fresnel_transmittance(cosine, n_, 1).mean();
}

double WaterSurface::reflectance_from_air(double cosine) const {
    return 1 - fresnel_transmittance(cosine, 1, n_).mean();
}

std::optional<Vector3> WaterSurface::into_air(const Vector3& direction) const {
    return refract(direction, up_, n_, 1);
}

Vector3 WaterSurface::into_water(const Vector3& direction) const {
    return refract(direction, -up_, 1, n_).value();
}

}  // namespace uw
