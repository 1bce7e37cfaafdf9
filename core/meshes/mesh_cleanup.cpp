#include "core/meshes/mesh_cleanup.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/stop.h"
#include "core/base/vec.h"

namespace uw {
namespace {

Vector3 position(const TriangleMesh& mesh, std::uint32_t vertex) {
    const float* p = &mesh.positions[3 * std::size_t{vertex}];
    return {p[0], p[1], p[2]};
}

bool usable(const Vector3& p) {
    // NaN fails every comparison.
    return std::abs(p.x) <= k_max_coordinate && std::abs(p.y) <= k_max_coordinate &&
           std::abs(p.z) <= k_max_coordinate;
}

/// The counter for a triangle's defect, or null if it has none.
std::uint64_t* fault_of(const TriangleMesh& mesh, std::size_t triangle, DroppedTriangles& dropped) {
    const std::uint32_t* corner = &mesh.triangles[3 * triangle];
    const std::size_t vertices = mesh.vertex_count();
    if (corner[0] >= vertices || corner[1] >= vertices || corner[2] >= vertices) {
        return &dropped.missing_corner;
    }
    const Vector3 a = position(mesh, corner[0]);
    const Vector3 b = position(mesh, corner[1]);
    const Vector3 c = position(mesh, corner[2]);
    if (!usable(a) || !usable(b) || !usable(c)) return &dropped.not_finite;
    return glm::cross(b - a, c - a) == Vector3(0.0) ? &dropped.no_area : nullptr;
}

void flatten_broken_normals(TriangleMesh& mesh) {
    for (std::size_t at = 0; at + 2 < mesh.normals.size(); at += 3) {
        float* n = &mesh.normals[at];
        const double length = glm::length(Vector3(n[0], n[1], n[2]));
        if (length > 1e-6 && length < 1e6) continue;
        n[0] = n[1] = n[2] = 0;
    }
}

}  // namespace

void drop_bad_triangles(TriangleMesh& mesh, DroppedTriangles& dropped) {
    const bool has_materials = !mesh.triangle_materials.empty();
    const bool has_objects = !mesh.triangle_objects.empty();
    std::size_t kept = 0;
    const std::size_t count = mesh.triangle_count();
    for (std::size_t triangle = 0; triangle < count; ++triangle) {
        throw_if_stopped();
        if (std::uint64_t* fault = fault_of(mesh, triangle, dropped)) {
            ++*fault;
            continue;
        }
        if (kept != triangle) {
            for (std::size_t k = 0; k < 3; ++k) {
                mesh.triangles[3 * kept + k] = mesh.triangles[3 * triangle + k];
            }
            if (has_materials) mesh.triangle_materials[kept] = mesh.triangle_materials[triangle];
            if (has_objects) mesh.triangle_objects[kept] = mesh.triangle_objects[triangle];
        }
        ++kept;
    }
    mesh.triangles.resize(3 * kept);
    if (has_materials) mesh.triangle_materials.resize(kept);
    if (has_objects) mesh.triangle_objects.resize(kept);
    flatten_broken_normals(mesh);
}

void DroppedTriangles::report(const std::string& name, std::vector<std::string>& warnings) const {
    const auto line = [&](std::uint64_t count, const char* what) {
        if (count > 0) warnings.push_back(fmt::format("{}: {} {}; dropped", name, count, what));
    };
    line(missing_corner, "triangles refer to vertices that do not exist");
    line(not_finite, "triangles have corners that are NaN, infinite or beyond 1e10");
    line(no_area, "triangles have no area");
}

}  // namespace uw
