#pragma once

#include <vector>

#include "tests/support/geometry_descs.h"
#include "tests/support/paths/path_scene.h"

namespace uw::test {

/// A box in front of a plane: light of every kind.
inline std::vector<GeometryDesc> box_and_plane(std::size_t bands) {
    return {with_reflectance(box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3}), 0.5, bands),
            with_reflectance(plane({0, 0, 3}, {0, 0, -1}), 0.5, bands)};
}

inline constexpr Point3 k_lamp{1, -0.5, 0};
inline const std::vector<BandOptics> k_three_bands{{0.35, 0.20}, {0.08, 0.22}, {0.05, 0.25}};

inline PathScene lit_scene(const std::vector<BandOptics>& bands) {
    PathScene scene(bands, 0.9);
    scene.set_surfaces(box_and_plane(bands.size()));
    scene.add_lamp(k_lamp, 1);
    return scene;
}

/// A ray that passes the box and meets the plane.
inline Ray some_ray() {
    return {{0, 0, 0}, glm::normalize(Vector3(-0.1, 0.05, 1))};
}

}  // namespace uw::test
