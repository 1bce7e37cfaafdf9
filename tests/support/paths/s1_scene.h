#pragma once

#include <vector>

#include "tests/support/geometry_descs.h"
#include "tests/support/paths/path_scene.h"

namespace uw::test {

/// The scene S1 that other renderers were measured on: a lamp beside the camera, a box and a plane
/// in forward-scattering water, in three bands.
inline PathScene s1_scene() {
    PathScene scene({{0.35, 0.20}, {0.08, 0.22}, {0.05, 0.25}}, 0.9);
    scene.set_surfaces({with_reflectance(plane({0, 0, 4}, {0, 0, -1}), 0.5, 3),
                        with_reflectance(box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3}), 0.5, 3)});
    scene.add_lamp({1, -0.5, 0}, 50);
    return scene;
}

/// The ray of its pinhole camera through a position in the image of 320 x 240 pixels.
inline Ray s1_ray(double x, double y) {
    constexpr double k_focal = 207.8461;
    return {{0, 0, 0}, glm::normalize(Vector3((x - 160) / k_focal, (y - 120) / k_focal, 1))};
}

}  // namespace uw::test
