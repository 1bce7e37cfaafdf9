#pragma once

#include <cstdint>
#include <memory>

#include "core/geometry/scene_objects.h"

namespace uw::test {

/// A flat sheet of 2 n^2 triangles over the unit square, at the height `z`, as it is traced.
inline std::shared_ptr<MeshObject> sheet_object(std::uint32_t n, double z) {
    auto object = std::make_shared<MeshObject>();
    for (std::uint32_t k = 0; k < (n + 1) * (n + 1); ++k)
        for (const double value : {double(k % (n + 1)) / n, double(k / (n + 1)) / n, z})
            object->mesh.positions.push_back(static_cast<float>(value));
    for (std::uint32_t k = 0; k < n * n; ++k) {
        const std::uint32_t a = k / n * (n + 1) + k % n;
        for (const std::uint32_t corner : {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1})
            object->mesh.triangles.push_back(corner);
    }
    object->vertex_count = object->mesh.positions.size() / 3;
    object->mesh.positions.resize(object->mesh.positions.size() + 4);  // Embree's padding
    return object;
}

}  // namespace uw::test
