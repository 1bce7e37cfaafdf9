#pragma once

#include "core/base/affine.h"

namespace uw {

/// Where an object shows a mesh that is not in world space.
struct MeshTransform {
    explicit MeshTransform(const Affine& map)
        : world_from_mesh(map),
          world_from_normal(glm::transpose(map.inverse().linear())),
          is_mirror(map.determinant() < 0) {}

    Affine world_from_mesh;     // invertible
    Matrix3 world_from_normal;  // changes lengths
    bool is_mirror = false;     // reverses the order of corners, and cross products
};

}  // namespace uw
