#include "camera/port/dome_port.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/port/refract.h"

namespace uw {
namespace {

constexpr int k_dome_max_iterations = 200;
/// Newton's last step [rad]; convergence is quadratic, so no error remains.
constexpr double k_dome_tolerance = 1e-13;
/// The origin of a water ray may be rounded into the glass by this fraction of its radius.
constexpr double k_dome_rounding = 1e-12;

/// Distance along a ray from `origin` (from the sphere's centre, inside) to the sphere.
double leave_sphere(const Vector3& origin, const Vector3& direction, double radius) {
    const double along = glm::dot(origin, direction);
    // radius^2 - origin^2 as a product: precise for a camera close to the glass.
    const double length = glm::length(origin);
    const double inside = (radius - length) * (radius + length);
    const double root = std::sqrt(along * along + inside);
    // The larger root of t^2 + 2 along t - inside, without cancellation.
    return along > 0 ? inside / (along + root) : root - along;
}

/// The angle to the radius at radius * index = `a` of the ray with Bouguer's invariant `h`, with
/// its derivative with respect to h; where h > a the ray does not get there, and the angle stays at
/// 90 degrees.
struct Angle {
    double value, slope;
};
Angle angle_at(double h, double a) {
    const double sine = h / a;
    if (!(sine < 1)) return {std::numbers::pi / 2, 0};
    return {std::asin(sine), 1 / (a * std::sqrt((1 - sine) * (1 + sine)))};
}

}  // namespace

std::optional<DomePort::Passage> DomePort::passage(const Point3& from,
                                                   const Vector3& direction) const {
    const Vector3 camera = from - desc_.center;
    const Vector3 inner = camera + leave_sphere(camera, direction, desc_.radius) * direction;
    const Vector3 inner_normal = glm::normalize(inner);
    const auto in_glass = refract(direction, inner_normal, desc_.n_air, desc_.n_glass);
    if (!in_glass) return std::nullopt;
    const double outer_radius = desc_.radius + desc_.thickness;
    const double through = desc_.thickness > 0 ? leave_sphere(inner, *in_glass, outer_radius) : 0;
    Passage result;
    result.outer = inner + through * *in_glass;
    const Vector3 outer_normal = glm::normalize(result.outer);
    const auto in_water = refract(*in_glass, outer_normal, desc_.n_glass, desc_.n_water);
    if (!in_water) return std::nullopt;
    result.in_water = *in_water;
    result.inner_air = glm::dot(direction, inner_normal);
    result.outer_glass = glm::dot(*in_glass, outer_normal);
    return result;
}

std::optional<Ray> DomePort::refracted_ray(const Point3& from, const Vector3& direction) const {
    const auto way = passage(from, direction);
    if (!way) return std::nullopt;
    return Ray{desc_.center + way->outer, way->in_water};
}

double DomePort::transmittance(const Vector3& direction) const {
    const auto way = passage(Point3{}, direction);
    if (!way) return 0;
    return port_transmittance(desc_, {way->inner_air, way->outer_glass});
}

std::optional<Vector3> DomePort::direction_to(const Point3& point) const {
    const Vector3 camera = -from_origin(desc_.center);
    const Vector3 target = point - desc_.center;
    const double offset = glm::length(camera), radius = glm::length(target);
    const double inner = desc_.radius, outer = desc_.radius + desc_.thickness;
    if (!std::isfinite(radius) || radius < (1 - k_dome_rounding) * outer) return std::nullopt;
    if (offset == 0) return target / radius;

    // In the plane of centre, camera and point: `u` towards the camera, `v` across.
    const Vector3 u = camera / offset;
    const double along = glm::dot(target, u);
    const Vector3 across = target - along * u;
    const double beside = glm::length(across);
    const double swept = std::atan2(beside, along);
    if (beside == 0) return along > 0 ? u : -u;

    // The angle that a ray sweeps increases with its own angle `a` to u, from 0 to pi, if the
    // indices increase from air to water and glass; a bracket keeps Newton's method safe if they do
    // not.
    double low = 0, high = std::numbers::pi, a = swept;
    bool passes = false;
    for (int iteration = 0; iteration < k_dome_max_iterations; ++iteration) {
        const double h = desc_.n_air * offset * std::sin(a);
        const Angle at_inner = angle_at(h, desc_.n_air * inner);
        const Angle into_glass = angle_at(h, desc_.n_glass * inner);
        const Angle at_outer = angle_at(h, desc_.n_glass * outer);
        const Angle into_water = angle_at(h, desc_.n_water * outer);
        const Angle at_point = angle_at(h, desc_.n_water * radius);
        passes = h < desc_.n_glass * inner && h < desc_.n_water * outer;
        const double excess = (a - swept) + (into_water.value - at_point.value) -
                              (at_inner.value - into_glass.value) - at_outer.value;
        const double slope = 1 + desc_.n_air * offset * std::cos(a) *
                                     (into_water.slope - at_point.slope - at_inner.slope +
                                      into_glass.slope - at_outer.slope);
        (excess > 0 ? high : low) = a;
        double next = a - excess / slope;
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        const double step = std::abs(next - a);
        a = next;
        if (step <= k_dome_tolerance) break;
    }
    if (!passes) return std::nullopt;
    return std::cos(a) * u + (std::sin(a) / beside) * across;
}

}  // namespace uw
