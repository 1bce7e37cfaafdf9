#pragma once

#include <array>
#include <optional>

#include "core/water_ray.h"

namespace uw {

/// Where in the image (pixels) a point of the water is seen, by Newton's method on the camera's
/// rays, to 0.01 pixel; empty if it is outside the image or behind the camera.
std::optional<std::array<double, 2>> pixel_of(const RaySource& camera, const Point3& point);

}  // namespace uw
