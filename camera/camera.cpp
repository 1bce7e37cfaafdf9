#include "camera/camera.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"

namespace uw {

Affine CameraMotion::at(double time) const {
    const auto last = static_cast<double>(poses_.size() - 1);
    const double place = std::clamp((time - span_.begin) / span_.length(), 0.0, 1.0) * last;
    const auto before = std::min(static_cast<std::size_t>(place), poses_.size() - 2);
    const double fraction = place - static_cast<double>(before);
    const Affine &a = poses_[before], &b = poses_[before + 1];
    return {(1 - fraction) * a.linear() + fraction * b.linear(),
            (1 - fraction) * a.offset() + fraction * b.offset()};
}

namespace {

/// How far from the axis the rays pass whose crossing is the focus [m]: narrow enough for their
/// aberration, of second order, to vanish, wide enough for rounding.
constexpr double k_paraxial = 1e-5;

Ray focused_ray(const Vector3& direction, const Vector3& from, double vergence) {
    return {at_origin_plus(from), glm::normalize(direction / direction.z - vergence * from)};
}

/// The distance between rays from around the aperture's centre, focused by `vergence`, at the plane
/// across `axis` (in water) through `focus`, relative to that at the aperture; 0: they meet there.
/// NaN if one of them does not enter the water.
double spread_at(const Point3& focus, const Ray& axis, const Port* port, double vergence) {
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
double vergence_of(const Point3& focus, const Ray& axis, const Port* port) {
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

ThinLens::ThinLens(const CameraDesc& desc, const Port* port)
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

Camera::Camera(const CameraDesc& desc)
    : width_(desc.width),
      height_(desc.height),
      intrinsics_(desc.intrinsics),
      lens_(make_lens_model(desc.distortion)),
      world_from_camera_(desc.world_from_camera),
      camera_from_world_(desc.world_from_camera.inverse()) {
    if (width_ <= 0 || height_ <= 0)
        throw std::logic_error("a camera without resolution: its calibration was not read");
    if (desc.port) {
        port_ = make_port(*desc.port);
        port_dims_ = std::visit(
            [](const auto& port) { return port.fresnel || port.radiance_in_air; }, *desc.port);
    }
    if (desc.lens && desc.lens->focus_distance) thin_lens_.emplace(desc, port_.get());
}

Camera::Camera(const CameraDesc& desc, std::shared_ptr<const CameraMotion> motion,
               const RowExposure& rows)
    : Camera(desc) {
    motion_ = std::move(motion);
    rows_ = rows;
}

std::optional<Vector3> Camera::lens_direction(double x, double y) const {
    const NormalizedPoint image{(x - intrinsics_.cx) / intrinsics_.fx,
                                (y - intrinsics_.cy) / intrinsics_.fy};
    return std::visit([&](const auto& lens) { return lens.direction(image); }, lens_);
}

std::optional<Ray> Camera::refracted_ray(double x, double y) const {
    const std::optional<Vector3> in_housing = lens_direction(x, y);
    if (!in_housing) return std::nullopt;
    const Ray ray{Point3{}, *in_housing};
    return motion_ ? in_water(ray, world_from_camera_at(y)) : in_water(ray, world_from_camera_);
}

std::optional<Ray> Camera::aperture_ray(double x, double y, const AperturePoint& point,
                                        double moment) const {
    const std::optional<Vector3> in_housing = lens_direction(x, y);
    if (!in_housing) return std::nullopt;
    const Ray ray = thin_lens_ ? thin_lens_->ray(*in_housing, point) : Ray{Point3{}, *in_housing};
    if (!motion_) return in_water(ray, world_from_camera_);
    const TimeSpan exposed = rows_.at(y);
    return in_water(ray, motion_->at(exposed.begin + moment * exposed.length()));
}

std::optional<Ray> Camera::in_water(const Ray& in_housing, const Affine& world_from_camera) const {
    const std::optional<Ray> in_camera = through_port(port_.get(), in_housing);
    if (!in_camera) return std::nullopt;
    return Ray{world_from_camera * in_camera->origin,
               glm::normalize(world_from_camera.apply_to_vector(in_camera->direction))};
}

LensRay Camera::lens_ray(double x, double y) const {
    const std::optional<Vector3> in_housing = lens_direction(x, y);
    if (!in_housing) return {0, 0};
    LensRay ray;
    ray.falloff = std::visit([&](const auto& lens) { return lens.falloff(*in_housing); }, lens_);
    if (port_) ray.port_transmittance = port_->transmittance(*in_housing);
    return ray;
}

std::optional<ImagePoint> Camera::project(const Point3& world) const {
    const std::optional<Projection> projection = project_at_its_time(world);
    return projection ? std::optional(projection->image) : std::nullopt;
}

std::optional<Sighting> Camera::sight(const Point3& world) const {
    const std::optional<Projection> projection = project_at_its_time(world);
    if (!projection) return std::nullopt;
    const Ray in_housing{Point3{}, projection->in_housing};
    const std::optional<Ray> ray =
        motion_ ? in_water(in_housing, world_from_camera_at(projection->image.y))
                : in_water(in_housing, world_from_camera_);
    return ray ? std::optional(Sighting{projection->image, *ray}) : std::nullopt;
}

std::optional<Camera::Projection> Camera::project_at_its_time(const Point3& world) const {
    if (!motion_ || rows_.line_time == 0)
        return project_in_camera(motion_ ? world_from_camera_at(0).inverse() * world
                                         : camera_from_world_ * world);
    // The row depends on the time, and the time on the row. Fixed-point iteration converges, since
    // a point crosses far less than one row in the time between two rows.
    constexpr int k_max_steps = 50;
    constexpr double k_close = 1e-9;  // [pixels]
    double row = 0.5 * height_;
    std::optional<Projection> projection;
    for (int step = 0; step < k_max_steps; ++step) {
        projection = project_in_camera(world_from_camera_at(row).inverse() * world);
        if (!projection || std::abs(projection->image.y - row) < k_close) break;
        row = projection->image.y;
    }
    return projection;
}

std::optional<Camera::Projection> Camera::project_in_camera(const Point3& point) const {
    std::optional<Vector3> in_housing;
    if (port_) {
        in_housing = port_->direction_to(point);
    } else if (const double range = glm::length(from_origin(point));
               range > 0 && std::isfinite(range)) {
        in_housing = from_origin(point) / range;
    }
    if (!in_housing) return std::nullopt;
    const auto image = std::visit([&](const auto& lens) { return lens.image(*in_housing); }, lens_);
    if (!image) return std::nullopt;
    return Projection{
        {intrinsics_.cx + intrinsics_.fx * image->x, intrinsics_.cy + intrinsics_.fy * image->y},
        *in_housing};
}

}  // namespace uw
