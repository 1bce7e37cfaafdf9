#include "camera/thin_lens.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/base/error.h"

namespace uw {
namespace {

/// How far from the axis the rays pass whose crossing is the focus [m]: narrow enough for their
/// aberration, of second order, to vanish, wide enough for rounding.
constexpr double k_paraxial = 1e-5;

Ray focused_ray(const Vector3& direction, const Vector3& from, double vergence) {
    return {at_origin_plus(from), glm::normalize(direction / direction.z - vergence * from)};
}

/// How far apart rays from around the aperture's centre, focused by `vergence`, are at the plane
/// across `axis` (in water) through `focus`, relative to how far they were; 0: they meet there. NaN
/// if one of them does not enter the water.
double spread_at(const Point3& focus, const Ray& axis, const std::optional<Port>& port,
                 double vergence) {
    constexpr std::array<std::array<double, 2>, 4> k_around{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
    double sum = 0;
    for (const auto& [u, v] : k_around) {
        const Vector3 beside(u, v, 0);
        const auto ray = through_port(port, focused_ray({0, 0, 1}, k_paraxial * beside, vergence));
        if (!ray) return std::nan("");
        const double along = glm::dot(focus - ray->origin, axis.direction) /
                             glm::dot(ray->direction, axis.direction);
        sum += glm::dot(ray->at(along) - focus, beside) / k_paraxial;
    }
    return sum / k_around.size();
}

/// The vergence at which rays near the axis meet `focus`; the spread is nearly linear in it.
double vergence_of(const Point3& focus, const Ray& axis, const std::optional<Port>& port) {
    double last = 0, here = 1 / focus.z;
    double last_spread = spread_at(focus, axis, port, last);
    for (int i = 0; i < 20; ++i) {
        const double spread = spread_at(focus, axis, port, here);
        const double slope = (spread - last_spread) / (here - last);
        if (spread == 0 || slope == 0) break;
        last = here;
        last_spread = spread;
        here -= spread / slope;
        if (std::abs(here - last) <= 1e-9 * std::abs(last)) break;
    }
    return here;
}

bool fits(const PortDesc& port, double radius) {
    const auto* dome = std::get_if<DomePortDesc>(&port);
    return dome == nullptr || glm::length(from_origin(dome->center)) + radius < dome->radius;
}

}  // namespace

ThinLens::ThinLens(const CameraDesc& desc, const std::optional<Port>& port)
    : radius_(desc.lens->focal_length / (2 * desc.lens->f_number)) {
    const double distance = *desc.lens->focus_distance;
    if (desc.port && !fits(*desc.port, radius_))
        throw InputError(
            fmt::format("{}: the lens's aperture, {:.3g} mm wide, does not fit into "
                        "the dome; check lens.focal_length, lens.f_number and port",
                        desc.where, 2e3 * radius_));
    const std::optional<Ray> axis = through_port(port, {Point3{}, {0, 0, 1}});
    const double along = axis ? (distance - axis->origin.z) / axis->direction.z : 0;
    if (!(along > 0) || distance <= desc.lens->focal_length)
        throw InputError(fmt::format(
            "{}: lens.focus_distance of {:g} m lies before the water, or within the focal length; "
            "give metres from the camera's centre along its axis",
            desc.where, distance));
    vergence_ = vergence_of(axis->at(along), *axis, port);
    if (!std::isfinite(vergence_))
        throw InputError(
            fmt::format("{}: no light along the camera's axis passes the port, so "
                        "that lens.focus_distance has no meaning; leave it out",
                        desc.where));
}

Ray ThinLens::ray(const Vector3& direction, const AperturePoint& point) const {
    return focused_ray(direction, radius_ * Vector3(point.u, point.v, 0), vergence_);
}

}  // namespace uw
