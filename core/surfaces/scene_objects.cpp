#include "core/surfaces/scene_objects.h"

#include <cmath>

#include "core/surfaces/mesh_surface.h"
#include "core/surfaces/microfacet.h"

namespace uw {
namespace {

Vector3 toward_viewer(const Vector3& normal, const Vector3& direction) {
    return glm::dot(normal, direction) > 0 ? -normal : normal;
}

/// The colour given in the scene, or that of the file.
Spectrum base_color(const MeshObject& object, const MeshPlace& place,
                    const ReflectanceBands& bands) {
    return object.reflectance ? *object.reflectance : bands.from_rgb(place.base_color());
}

}  // namespace

Point3 MeshObject::corner(std::uint32_t triangle, int k) const {
    const std::uint32_t vertex = mesh.triangles[3 * std::size_t{triangle} + std::size_t(k)];
    const float* p = &mesh.positions[3 * std::size_t{vertex}];
    return {p[0], p[1], p[2]};
}

bool MeshObject::is_hole(std::uint32_t triangle, const TriangleCrossing& crossing) const {
    return MeshPlace(mesh, triangle, crossing.u, crossing.v).is_hole();
}

Bounds SphereObject::world_bounds() const {
    const Point3 middle = world_from_object * center;
    const Matrix3 rows = glm::transpose(world_from_object.linear());
    Bounds bounds;
    const Vector3 reach(glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2]));
    bounds.extend(middle - radius * reach);
    bounds.extend(middle + radius * reach);
    return bounds;
}

std::optional<TriangleCrossing> cross_triangle(const PlacedMesh& mesh, std::uint32_t triangle,
                                               const Point3& origin, const Vector3& direction) {
    const Point3 a = mesh.corner(triangle, 0);
    const Vector3 ab = mesh.corner(triangle, 1) - a, ac = mesh.corner(triangle, 2) - a;
    const Vector3 p = glm::cross(direction, ac);
    const double determinant = glm::dot(ab, p);
    if (determinant == 0) return std::nullopt;
    const Vector3 s = origin - a;
    const Vector3 q = glm::cross(s, ab);
    const TriangleCrossing crossing{glm::dot(ac, q) / determinant, glm::dot(s, p) / determinant,
                                    glm::dot(direction, q) / determinant};
    constexpr double k_outside = TriangleCrossing::k_edge_margin;
    const bool inside = crossing.u >= -k_outside && crossing.v >= -k_outside &&
                        crossing.u + crossing.v <= 1 + k_outside;
    return inside ? std::optional(crossing) : std::nullopt;
}

std::optional<SphereCrossings> cross_sphere(const SphereObject& sphere, const Point3& origin,
                                            const Vector3& direction) {
    const Vector3 along = sphere.object_from_world.apply_to_vector(direction);
    const double length = glm::length(along);
    const Vector3 unit = along / length;
    const Vector3 to_center = sphere.center - sphere.object_from_world * origin;
    const double middle = glm::dot(to_center, unit);
    // The distance of the centre from the line, computed from the perpendicular itself: the
    // textbook difference of squares loses half the digits for small or distant spheres.
    const Vector3 off = to_center - middle * unit;
    const double half_squared = sphere.radius * sphere.radius - glm::dot(off, off);
    if (!(half_squared >= 0)) return std::nullopt;
    const double half = std::sqrt(half_squared);
    return SphereCrossings{(middle - half) / length, (middle + half) / length};
}

std::optional<double> cross_plane(const PlaneObject& plane, const Point3& origin,
                                  const Vector3& direction) {
    const double slope = glm::dot(direction, plane.normal);
    if (slope == 0) return std::nullopt;
    return glm::dot(plane.point - origin, plane.normal) / slope;
}

void shade_mesh(const PlacedMesh& mesh, std::uint32_t triangle, const TriangleCrossing& crossing,
                const ReflectanceBands& bands, const Vector3& direction, SurfaceHit& hit) {
    const MeshObject& object = mesh.object;
    const Point3 a = mesh.corner(triangle, 0);
    const Vector3 area = glm::cross(mesh.corner(triangle, 1) - a, mesh.corner(triangle, 2) - a);
    const double size = glm::length(area);
    const Vector3 flat = size > 0 ? area / size : -direction;
    const MeshPlace place(object.mesh, triangle, crossing.u, crossing.v, mesh.transform());
    hit.geometric_normal = toward_viewer(flat, direction);
    hit.normal = place.shading_normal(hit.geometric_normal);
    hit.reflectance = base_color(object, place, bands);
    hit.has_material = object.is_pbr || place.material().emission != Rgb{0, 0, 0};
    if (object.is_pbr) {
        const double metallic = place.roughness_metallic()[1];
        for (double& rho : hit.reflectance) rho *= 1 - metallic;
    }
    hit.triangle = triangle;
    hit.u = crossing.u;
    hit.v = crossing.v;
    hit.object_id = mesh.object_id(triangle);
    const std::uint32_t number = place.material().number;
    hit.material_id = number == 0 ? 0 : object.materials_end + number;
}

SurfaceMaterial material_of_mesh(const PlacedMesh& mesh, const ReflectanceBands& bands,
                                 const SurfaceHit& hit) {
    const MeshObject& object = mesh.object;
    const MeshPlace place(object.mesh, hit.triangle, hit.u, hit.v);
    SurfaceMaterial material;
    material.emission = bands.from_rgb(place.emission());
    material.is_glossy = object.is_pbr;
    if (!object.is_pbr) return material;
    const auto [roughness, metallic] = place.roughness_metallic();
    material.roughness = roughness;
    const double dielectric = dielectric_f0(place.material().ior);
    const Spectrum metal = base_color(object, place, bands);
    for (std::size_t b = 0; b < static_cast<std::size_t>(bands.count()); ++b) {
        material.f0[b] = (1 - metallic) * dielectric + metallic * metal[b];
    }
    return material;
}

void shade_sphere(const SphereObject& sphere, const Vector3& direction, SurfaceHit& hit) {
    const Vector3 outward = sphere.object_from_world * hit.position - sphere.center;
    // Normals are mapped by the inverse transpose; the inverse is available.
    const Vector3 normal =
        glm::normalize(glm::transpose(sphere.object_from_world.linear()) * outward);
    hit.geometric_normal = hit.normal = toward_viewer(normal, direction);
    hit.reflectance = sphere.reflectance;
    hit.has_material = false;
    hit.material_id = 0;
    hit.object_id = sphere.object_id;
}

void shade_plane(const PlaneObject& plane, const Vector3& direction, SurfaceHit& hit) {
    hit.geometric_normal = hit.normal = toward_viewer(plane.normal, direction);
    hit.reflectance = plane.reflectance;
    hit.has_material = false;
    hit.material_id = 0;
    hit.object_id = plane.object_id;
}

}  // namespace uw
