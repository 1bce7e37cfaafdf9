#include "camera/camera.h"

namespace uw {

Camera::Camera(const CameraDesc& desc)
    : width_(desc.width),
      height_(desc.height),
      intrinsics_(desc.intrinsics),
      distortion_(desc.distortion),
      world_from_camera_(desc.world_from_camera) {
    if (desc.port) port_.emplace(*desc.port);
}

std::optional<Vector3> Camera::direction(double x, double y) const {
    const auto undistorted = distortion_.undistort(
        {(x - intrinsics_.cx) / intrinsics_.fx, (y - intrinsics_.cy) / intrinsics_.fy});
    if (!undistorted) return std::nullopt;
    return glm::normalize(Vector3(undistorted->x, undistorted->y, 1));
}

std::optional<Ray> Camera::water_ray(double x, double y) const {
    const std::optional<Vector3> in_housing = direction(x, y);
    if (!in_housing) return std::nullopt;
    const std::optional<Ray> in_camera =
        port_ ? port_->water_ray(*in_housing) : Ray{Point3{}, *in_housing};
    if (!in_camera) return std::nullopt;
    return Ray{world_from_camera_ * in_camera->origin,
               glm::normalize(world_from_camera_.apply_to_vector(in_camera->direction))};
}

LensRay Camera::lens_ray(double x, double y) const {
    const std::optional<Vector3> in_housing = direction(x, y);
    if (!in_housing) return {0, 0};
    return {in_housing->z, port_ ? port_->transmittance(*in_housing) : 1.0};
}

}  // namespace uw
