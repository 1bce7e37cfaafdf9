#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/base/vector_math.h"
#include "core/geometry/mesh.h"
#include "core/geometry/surfaces.h"
#include "core/geometry/textured_surfaces.h"

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

/// Where a line crosses a triangle, in units of its direction's length.
struct TriangleCrossing {
    double t = 0;
    double u = 0, v = 0;  // barycentric: (1 - u - v) a + u b + v c

    /// Whether the crossing lies inside the triangle, farther from its edges than float rounding.
    bool well_inside() const {
        return u > k_edge_margin && v > k_edge_margin && u + v < 1 - k_edge_margin;
    }
    /// Error bound of single precision, as a fraction of the triangle's size.
    static constexpr double k_edge_margin = 1e-3;
};

/// A triangle mesh, in world space unless instances show it. Its positions are followed by the 4
/// floats that Embree may read past the last vertex.
struct MeshObject {
    TriangleMesh mesh;
    std::uint32_t object_id = 0;          // of its object 0; the others follow
    std::uint32_t materials_end = 0;      // id of the last material before its file's first
    std::optional<Spectrum> reflectance;  // overrides the mesh's colours
    std::size_t vertex_count = 0;
    bool has_holes = false;     // some material has an alpha cutoff
    bool is_pbr = false;        // metallic-roughness material; else diffuse
    bool has_textures = false;  // some material has one

    /// Whether a triangle has a hole at the crossing. For meshes with holes.
    bool is_hole(std::uint32_t triangle, const TriangleCrossing& crossing) const;
    /// Corner `k` (0..2) of a triangle.
    Point3 corner(std::uint32_t triangle, int k) const;
};

/// One object of several that show the same mesh. Embree traces the mesh in its own space;
/// crossings, normals and tangents are transformed corner by corner in double precision, so that
/// the object looks as a copy of the mesh would.
struct MeshInstance {
    const MeshObject* object = nullptr;
    MeshTransform transform;
    std::uint32_t object_id = 0;
};

/// A mesh where the scene has it: in world space, or as an instance.
struct PlacedMesh {
    const MeshObject& object;
    const MeshInstance* instance = nullptr;

    PlacedMesh(const MeshObject& mesh, const MeshInstance* placed = nullptr)
        : object(mesh), instance(placed) {}

    const MeshTransform* transform() const { return instance ? &instance->transform : nullptr; }
    /// The id of a triangle's object.
    std::uint32_t object_id(std::uint32_t triangle) const {
        const std::vector<std::uint32_t>& objects = object.mesh.triangle_objects;
        return (instance ? instance->object_id : object.object_id) +
               (objects.empty() ? 0 : objects[triangle]);
    }
    /// Corner `k` (0..2) of a triangle, in world space.
    Point3 corner(std::uint32_t triangle, int k) const {
        const Point3 p = object.corner(triangle, k);
        return instance ? instance->transform.world_from_mesh * p : p;
    }
};

/// A sphere in object space, an ellipsoid in the world.
struct SphereObject {
    Affine world_from_object, object_from_world;
    Point3 center;
    double radius = 0;
    std::uint32_t object_id = 0;
    Spectrum reflectance{};

    Bounds world_bounds() const;
};

/// An infinite plane in world space.
struct PlaneObject {
    Point3 point;
    Vector3 normal{0, 0, 1};  // unit
    std::uint32_t object_id = 0;
    Spectrum reflectance{};
};

/// All surfaces of a scene, before and after Embree's acceleration structure is built over them.
struct SceneObjects {
    std::vector<std::shared_ptr<const MeshObject>> meshes;         // in world space
    std::vector<std::shared_ptr<const MeshObject>> shared_meshes;  // shown by instances
    std::vector<MeshInstance> instances;
    std::vector<SphereObject> spheres;
    std::vector<PlaneObject> planes;
    Bounds bounds;  // of meshes, instances and spheres
    ReflectanceBands bands;
    SurfaceNames names;

    /// Number of meshes as the scene has them: those in world space, then the instances.
    std::size_t placed_count() const { return meshes.size() + instances.size(); }
    PlacedMesh placed(std::size_t number) const {
        if (number < meshes.size()) return *meshes[number];
        const MeshInstance& instance = instances[number - meshes.size()];
        return {*instance.object, &instance};
    }
};

/// The crossing of a line with the plane of a triangle (Moeller & Trumbore 1997) in double
/// precision. Empty if it misses the triangle by more than k_edge_margin, as can happen for lines
/// nearly in its plane.
std::optional<TriangleCrossing> cross_triangle(const PlacedMesh& mesh, std::uint32_t triangle,
                                               const Point3& origin, const Vector3& direction);

/// Both crossings of a line with a sphere, the nearer first; empty if it misses.
struct SphereCrossings {
    double near = 0, far = 0;
};
std::optional<SphereCrossings> cross_sphere(const SphereObject& sphere, const Point3& origin,
                                            const Vector3& direction);

/// Where a line crosses a plane; empty if it is parallel to it.
std::optional<double> cross_plane(const PlaneObject& plane, const Point3& origin,
                                  const Vector3& direction);

/// Fill all of `hit` except `distance` and `position`, which are given; `direction` is the ray's,
/// and the normals are turned to face it.
void shade_mesh(const PlacedMesh& mesh, std::uint32_t triangle, const TriangleCrossing& crossing,
                const ReflectanceBands& bands, const Vector3& direction, SurfaceHit& hit);

/// TexturedSurfaces::add_to_texture for the hit of a mesh.
void add_to_texture_of_mesh(const PlacedMesh& mesh, const ReflectanceBands& bands,
                            const SurfaceHit& hit, std::span<const double> by_reflectance,
                            TextureGradient& gradient);

/// Whether the material of a mesh's triangle has a texture that affects what filter_mesh replaces.
bool is_textured_mesh(const PlacedMesh& mesh, std::uint32_t triangle);

/// TexturedSurfaces::filter_textures for the hit of a mesh (SurfaceHit::triangle).
void filter_mesh(const PlacedMesh& mesh, const ReflectanceBands& bands, const SurfaceSpread& spread,
                 SurfaceHit& hit);

/// The material, beyond diffuse reflection, of the triangle of `hit` (SurfaceHit::triangle).
SurfaceMaterial material_of_mesh(const PlacedMesh& mesh, const ReflectanceBands& bands,
                                 const SurfaceHit& hit);
void shade_sphere(const SphereObject& sphere, const Vector3& direction, SurfaceHit& hit);
void shade_plane(const PlaneObject& plane, const Vector3& direction, SurfaceHit& hit);
}  // namespace uw
