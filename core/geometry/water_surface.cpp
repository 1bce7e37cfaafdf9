#include "core/geometry/water_surface.h"

#include <cmath>

#include "core/base/refraction.h"
#include "core/geometry/waves.h"

namespace uw {

namespace {

// How far below the surface reflected rays begin [m]: more than the error of the crossing.
constexpr double k_below = 1e-6;

}  // namespace

WaterSurface::WaterSurface(const WaterSurfaceDesc& desc, double time)
    : point_(desc.point), up_(desc.normal), n_(desc.n.value()) {
    // x where the surface is level, y where x is up.
    const Vector3 x(1, 0, 0), y(0, 1, 0);
    const Vector3& reference = glm::length(glm::cross(up_, x)) > 1e-6 ? x : y;
    across_ = glm::normalize(reference - glm::dot(reference, up_) * up_);
    along_ = glm::cross(up_, across_);
    if (desc.waves) waves_ = std::make_shared<const WaterWaves>(*desc.waves, time);
}

double WaterSurface::lowest() const {
    return waves_ ? waves_->lowest() : 0;
}

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

std::optional<WaterSurface::Meeting> WaterSurface::meet(const Ray& ray, double s_end) const {
    if (!waves_) {
        const std::optional<double> distance = crossing(ray);
        if (!distance || *distance > s_end) return std::nullopt;
        return Meeting{*distance, up_};
    }
    const Point3 origin = at_origin_plus(coordinates(ray.origin));
    const Vector3 direction = in_plane(ray.direction);
    const std::optional<double> distance = waves_->intersect(origin, direction, s_end);
    if (!distance) return std::nullopt;
    const Point3 at = origin + *distance * direction;
    const Vector3 normal = waves_->at(at.x, at.y).normal();
    return Meeting{*distance, normal.x * across_ + normal.y * along_ + normal.z * up_};
}

Ray WaterSurface::reflected(const Ray& ray, const Meeting& meeting) const {
    const Vector3 direction =
        ray.direction - 2 * glm::dot(ray.direction, meeting.normal) * meeting.normal;
    return {ray.at(meeting.distance) - k_below * meeting.normal, glm::normalize(direction)};
}

double WaterSurface::reflectance_from_water(double cosine) const {
    return 1 - fresnel_transmittance(cosine, n_, 1).mean();
}

double WaterSurface::reflectance_from_air(double cosine) const {
    return 1 - fresnel_transmittance(cosine, 1, n_).mean();
}

std::optional<Vector3> WaterSurface::into_air(const Vector3& direction,
                                              const Vector3& normal) const {
    return refract(direction, normal, n_, 1);
}

std::optional<Vector3> WaterSurface::refracted_into_water(const Vector3& direction,
                                                          const Vector3& normal) const {
    return refract(direction, -normal, 1, n_);
}

Vector3 WaterSurface::into_water(const Vector3& direction) const {
    return refract(direction, -up_, 1, n_).value();
}

}  // namespace uw
