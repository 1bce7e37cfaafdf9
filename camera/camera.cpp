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

std::optional<Ray> Camera::water_ray(double x, double y) const {
    const auto undistorted = distortion_.undistort(
        {(x - intrinsics_.cx) / intrinsics_.fx, (y - intrinsics_.cy) / intrinsics_.fy});
    if (!undistorted) return std::nullopt;
    const Vector3 direction = glm::normalize(Vector3(undistorted->x, undistorted->y, 1));
    const std::optional<Ray> in_camera =
        port_ ? port_->water_ray(direction) : Ray{Point3{}, direction};
    if (!in_camera) return std::nullopt;
    return Ray{world_from_camera_ * in_camera->origin,
               glm::normalize(world_from_camera_.apply_to_vector(in_camera->direction))};
}

}  // namespace uw
