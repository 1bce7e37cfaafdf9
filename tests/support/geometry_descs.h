#pragma once

#include <filesystem>

#include "core/scene/geometry_desc.h"

/// Surfaces as a scene describes them, with the default reflectance.
namespace uw::test {

inline GeometryDesc sphere(const Point3& center, double radius) {
    GeometryDesc desc;
    desc.type = GeometryDesc::Type::sphere;
    desc.center = center;
    desc.radius = radius;
    return desc;
}

inline GeometryDesc box(const Point3& min, const Point3& max) {
    GeometryDesc desc;
    desc.type = GeometryDesc::Type::box;
    desc.min = min;
    desc.max = max;
    return desc;
}

/// `normal` of any length.
inline GeometryDesc plane(const Point3& point, const Vector3& normal) {
    GeometryDesc desc;
    desc.type = GeometryDesc::Type::plane;
    desc.point = point;
    desc.normal = glm::normalize(normal);
    return desc;
}

/// The mesh of the project's example scene.
inline GeometryDesc seabed() {
    GeometryDesc desc;
    desc.file = std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/meshes/seabed.glb";
    return desc;
}

}  // namespace uw::test
