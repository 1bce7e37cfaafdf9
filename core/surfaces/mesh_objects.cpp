#include "core/surfaces/mesh_objects.h"

#include <algorithm>
#include <utility>

namespace uw {
namespace {

bool is_identity(const Affine& map) {
    return map.linear() == Matrix3(1.0) && map.offset() == Vector3(0.0);
}

/// Whether a material has more than the colour that a given reflectance replaces.
bool has_more_than_color(const MeshMaterial& material) {
    return material.alpha_cutoff > 0 || material.normal_map || material.emission != Rgb{0, 0, 0};
}

}  // namespace

void place_mesh(TriangleMesh& mesh, const Affine& world_from_object) {
    if (is_identity(world_from_object)) return;
    for (std::size_t at = 0; at + 2 < mesh.positions.size(); at += 3) {
        float* p = &mesh.positions[at];
        const Point3 world = world_from_object * Point3{p[0], p[1], p[2]};
        for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<float>(world[axis]);
    }
    const Matrix3 normal_map = glm::transpose(world_from_object.inverse().linear());
    for (std::size_t at = 0; at + 2 < mesh.normals.size(); at += 3) {
        float* n = &mesh.normals[at];
        const Vector3 world = normal_map * Vector3(n[0], n[1], n[2]);
        const double length = glm::length(world);
        if (!(length > 0)) continue;  // zero means "flat"
        for (int axis = 0; axis < 3; ++axis) n[axis] = static_cast<float>(world[axis] / length);
    }
    if (mesh.tangents.empty()) return;
    // A mirroring transform reverses the corner order and cross products.
    const bool is_mirror = world_from_object.determinant() < 0;
    const float side = is_mirror ? -1.0F : 1.0F;
    for (std::size_t at = 0; is_mirror && at + 2 < mesh.triangles.size(); at += 3) {
        std::swap(mesh.triangles[at + 1], mesh.triangles[at + 2]);
    }
    for (std::size_t at = 0; at + 3 < mesh.tangents.size(); at += 4) {
        float* t = &mesh.tangents[at];
        const Vector3 world = world_from_object.apply_to_vector({t[0], t[1], t[2]});
        const double length = glm::length(world);
        for (int axis = 0; axis < 3; ++axis) {
            t[axis] = length > 0 ? static_cast<float>(world[axis] / length) : 0.0F;
        }
        t[3] *= side;
    }
}

Bounds bounds_of(const TriangleMesh& mesh) {
    Bounds bounds;
    for (const std::uint32_t vertex : mesh.triangles) {
        const float* p = &mesh.positions[3 * std::size_t{vertex}];
        bounds.extend(Point3{p[0], p[1], p[2]});
    }
    return bounds;
}

std::shared_ptr<MeshObject> make_mesh_object(const GeometryDesc& desc, TriangleMesh mesh,
                                             const std::optional<Spectrum>& reflectance) {
    auto object = std::make_shared<MeshObject>();
    object->mesh = std::move(mesh);
    object->reflectance = reflectance;
    object->is_pbr = desc.is_pbr;
    object->vertex_count = object->mesh.vertex_count();
    auto& materials = object->mesh.materials;
    object->has_holes = std::ranges::any_of(
        materials, [](const MeshMaterial& material) { return material.alpha_cutoff > 0; });
    if (reflectance && !desc.is_pbr && std::ranges::none_of(materials, has_more_than_color)) {
        object->mesh.uvs = {};
        object->mesh.colors = {};
        for (MeshMaterial& material : materials) material.base_map = {};
    }
    object->mesh.positions.resize(object->mesh.positions.size() + 4);  // Embree's padding
    return object;
}

}  // namespace uw
