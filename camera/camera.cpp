#include "camera/camera.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace uw {

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
        port_.emplace(make_port(*desc.port));
        port_dims_ = std::visit(
            [](const auto& port) { return port.fresnel || port.radiance_in_air; }, *desc.port);
    }
    if (desc.lens && desc.lens->focus_distance) thin_lens_.emplace(desc, port_);
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
    const std::optional<Ray> in_camera = through_port(port_, in_housing);
    if (!in_camera) return std::nullopt;
    return Ray{world_from_camera * in_camera->origin,
               glm::normalize(world_from_camera.apply_to_vector(in_camera->direction))};
}

LensRay Camera::lens_ray(double x, double y) const {
    const std::optional<Vector3> in_housing = lens_direction(x, y);
    if (!in_housing) return {0, 0};
    LensRay ray;
    ray.falloff = std::visit([&](const auto& lens) { return lens.falloff(*in_housing); }, lens_);
    if (port_)
        ray.port_transmittance =
            std::visit([&](const auto& port) { return port.transmittance(*in_housing); }, *port_);
    return ray;
}

std::optional<ImagePoint> Camera::project(const Point3& world) const {
    const std::optional<Projection> seen = project_at_its_time(world);
    return seen ? std::optional(seen->image) : std::nullopt;
}

std::optional<Sighting> Camera::sight(const Point3& world) const {
    const std::optional<Projection> seen = project_at_its_time(world);
    if (!seen) return std::nullopt;
    const Ray in_housing{Point3{}, seen->in_housing};
    const std::optional<Ray> ray = motion_
                                       ? in_water(in_housing, world_from_camera_at(seen->image.y))
                                       : in_water(in_housing, world_from_camera_);
    return ray ? std::optional(Sighting{seen->image, *ray}) : std::nullopt;
}

std::optional<Camera::Projection> Camera::project_at_its_time(const Point3& world) const {
    if (!motion_ || rows_.line_time == 0)
        return project_in_camera(motion_ ? world_from_camera_at(0).inverse() * world
                                         : camera_from_world_ * world);
    // The row depends on the time, and the time on the row: by iteration, since a point crosses far
    // fewer rows in the time between two than one.
    constexpr int k_most_steps = 50;
    constexpr double k_close = 1e-9;  // [pixels]
    double row = 0.5 * height_;
    std::optional<Projection> seen;
    for (int step = 0; step < k_most_steps; ++step) {
        seen = project_in_camera(world_from_camera_at(row).inverse() * world);
        if (!seen || std::abs(seen->image.y - row) < k_close) break;
        row = seen->image.y;
    }
    return seen;
}

std::optional<Camera::Projection> Camera::project_in_camera(const Point3& point) const {
    std::optional<Vector3> in_housing;
    if (port_) {
        in_housing = std::visit([&](const auto& port) { return port.direction_to(point); }, *port_);
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
