#pragma once

#include <limits>

#include "camera/camera.h"
#include "core/surfaces/surfaces.h"

namespace uw {

/// How a camera sees a point of the world.
struct SeenPoint {
    static constexpr double k_none = std::numeric_limits<double>::quiet_NaN();

    ImagePoint pixel{k_none, k_none};  // NaN: no ray leads to it
    double path = k_none;              // in the water, along its ray [m]
    bool in_image = false;
    bool visible = false;  // in the image, and no surface lies before it
};

/// Whether a position lies within the camera's image, whose edges belong to it.
bool is_in_image(const ImagePoint& pixel, const Camera& camera);

/// Through lens and port (Camera::project). NaN is seen nowhere.
SeenPoint seen_point(const Point3& world, const Camera& camera, const Surfaces& surfaces);

}  // namespace uw
