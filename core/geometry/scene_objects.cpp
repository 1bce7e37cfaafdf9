#include "core/geometry/scene_objects.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/mesh.h"
#include "core/geometry/surface_reflection.h"

namespace uw {

namespace {

/// A point on a triangle of a mesh, for evaluating textures, vertex colours and normals.
class MeshPlace {
  public:
    /// Barycentric u and v: (1 - u - v) a + u b + v c; clamped to the triangle. Refers to `mesh`,
    /// and to the transform of a mesh that is not in world space. Textures are taken over `spread`.
    MeshPlace(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v,
              const MeshTransform* transform = nullptr, const SurfaceSpread& spread = {});

    const MeshMaterial& material() const { return *material_; }
    /// Linear RGB 0..1.
    Rgb base_color() const;
    /// The transpose of that, for texels of the base map if it is the gradient's texture.
    void add_base_color(const Rgb& weights, TextureGradient& gradient) const;
    /// Whether the surface has a hole here (MeshMaterial::alpha_cutoff).
    bool is_hole() const;
    /// Radiance [W m^-2 sr^-1], in linear RGB.
    Rgb emission() const;
    /// Roughness and metallic, 0..1.
    std::array<double, 2> roughness_metallic() const;

    /// The interpolated vertex normal, or the flat one if a corner has none, perturbed by the
    /// normal map. `flat` is the triangle's normal on the viewer's side, and the result is on that
    /// side too: at grazing angles an interpolated normal may point away from the viewer. In world
    /// space, as of a copy of the mesh whose vertices have been transformed.
    Vector3 shading_normal(const Vector3& flat) const;

  private:
    Rgb sample(const TextureUse& use) const;
    TextureSpread spread_on(const TextureUse& use) const;
    /// A vector of the triangle's plane, in world space, as a sum of the edges from its corner 0.
    std::array<double, 2> in_edges(const Vector3& v) const;
    /// Weighted means over the corners.
    double mean(const std::vector<float>& values, std::size_t width, std::size_t component) const;
    /// Unit vertex normal or tangent of corner `k`, in world space; zero if there is none.
    Vector3 corner_normal(std::size_t k) const;
    Vector3 corner_tangent(std::size_t k) const;
    /// A vector of the mesh's space in world space.
    Vector3 in_world(const Vector3& v) const;
    /// From the vertex normals; empty if a corner has none.
    std::optional<Vector3> interpolated_normal() const;
    /// `flat` on the side from which the corners appear counter-clockwise.
    Vector3 turn_side(const Vector3& flat) const;
    /// `normal`, on the file's side of the surface, perturbed by the normal map.
    Vector3 bent(const Vector3& normal) const;

    const TriangleMesh* mesh_;
    const MeshMaterial* material_;
    const std::uint32_t* corners_;
    const MeshTransform* transform_;
    std::array<double, 3> weights_;
    bool is_spread_ = false;
    std::array<double, 2> across_{}, down_{};  // of the spread, in_edges
};

Vector3 unit_or_zero(const Vector3& v) {
    const double length = glm::length(v);
    return length > 0 ? v / length : Vector3(0.0);
}

MeshPlace::MeshPlace(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v,
                     const MeshTransform* transform, const SurfaceSpread& spread)
    : mesh_(&mesh),
      material_(
          &mesh.materials[mesh.triangle_materials.empty() ? 0 : mesh.triangle_materials[triangle]]),
      corners_(&mesh.triangles[3 * std::size_t{triangle}]),
      transform_(transform) {
    const double b = std::clamp(u, 0.0, 1.0), c = std::clamp(v, 0.0, 1.0 - b);
    weights_ = {1 - b - c, b, c};
    is_spread_ = spread.across != Vector3(0.0) || spread.down != Vector3(0.0);
    if (!is_spread_) return;
    across_ = in_edges(spread.across);
    down_ = in_edges(spread.down);
}

std::array<double, 2> MeshPlace::in_edges(const Vector3& v) const {
    const auto corner = [&](std::size_t k) {
        const float* at = &mesh_->positions[3 * std::size_t{corners_[k]}];
        return Vector3(at[0], at[1], at[2]);
    };
    const Vector3 b = in_world(corner(1) - corner(0)), c = in_world(corner(2) - corner(0));
    const double bb = glm::dot(b, b), bc = glm::dot(b, c), cc = glm::dot(c, c);
    const double determinant = bb * cc - bc * bc;
    if (!(determinant > 0)) return {};
    const double vb = glm::dot(v, b), vc = glm::dot(v, c);
    return {(cc * vb - bc * vc) / determinant, (bb * vc - bc * vb) / determinant};
}

double MeshPlace::mean(const std::vector<float>& values, std::size_t width,
                       std::size_t component) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        sum += weights_[k] * values[width * std::size_t{corners_[k]} + component];
    }
    return sum;
}

Vector3 MeshPlace::in_world(const Vector3& v) const {
    return transform_ == nullptr ? v : transform_->world_from_mesh.apply_to_vector(v);
}

Vector3 MeshPlace::corner_normal(std::size_t k) const {
    const float* n = &mesh_->normals[3 * std::size_t{corners_[k]}];
    const Vector3 normal(n[0], n[1], n[2]);
    return transform_ == nullptr ? normal : unit_or_zero(transform_->world_from_normal * normal);
}

Vector3 MeshPlace::corner_tangent(std::size_t k) const {
    const float* t = &mesh_->tangents[4 * std::size_t{corners_[k]}];
    const Vector3 tangent(t[0], t[1], t[2]);
    return transform_ == nullptr ? tangent : unit_or_zero(in_world(tangent));
}

TextureSpread MeshPlace::spread_on(const TextureUse& use) const {
    if (!is_spread_) return {};
    const std::vector<float>& uvs = mesh_->uvs[use.uv_set];
    const auto edge = [&](std::size_t k, std::size_t component) {
        return static_cast<double>(uvs[2 * std::size_t{corners_[k]} + component]) -
               static_cast<double>(uvs[2 * std::size_t{corners_[0]} + component]);
    };
    const auto in_texture = [&](const std::array<double, 2>& side) {
        return std::array<double, 2>{side[0] * edge(1, 0) + side[1] * edge(2, 0),
                                     side[0] * edge(1, 1) + side[1] * edge(2, 1)};
    };
    return {in_texture(across_), in_texture(down_)};
}

Rgb MeshPlace::sample(const TextureUse& use) const {
    const std::vector<float>& uvs = mesh_->uvs[use.uv_set];
    const double u = mean(uvs, 2, 0), v = mean(uvs, 2, 1);
    return is_spread_ ? use.sample(u, v, spread_on(use)) : use.sample(u, v);
}

void MeshPlace::add_base_color(const Rgb& weights, TextureGradient& gradient) const {
    const TextureUse& use = material_->base_map;
    if (use.texture.get() != &gradient.texture()) return;
    Rgb of_texture = weights;
    for (std::size_t i = 0; i < 3; ++i) {
        of_texture[i] *= material_->base_color[i];
        if (!mesh_->colors.empty()) of_texture[i] *= mean(mesh_->colors, 3, i);
    }
    const std::vector<float>& uvs = mesh_->uvs[use.uv_set];
    use.add_to(gradient, mean(uvs, 2, 0), mean(uvs, 2, 1), spread_on(use), of_texture);
}

Rgb MeshPlace::base_color() const {
    Rgb color = material_->base_color;
    if (material_->base_map) {
        const Rgb texel = sample(material_->base_map);
        for (std::size_t i = 0; i < 3; ++i) color[i] *= texel[i];
    }
    if (!mesh_->colors.empty()) {
        for (std::size_t i = 0; i < 3; ++i) color[i] *= mean(mesh_->colors, 3, i);
    }
    return color;
}

bool MeshPlace::is_hole() const {
    if (material_->alpha_cutoff <= 0) return false;
    double alpha = material_->alpha;
    if (const TextureUse& use = material_->base_map) {
        const std::vector<float>& uvs = mesh_->uvs[use.uv_set];
        alpha *= use.sample_alpha(mean(uvs, 2, 0), mean(uvs, 2, 1));
    }
    if (!mesh_->alphas.empty()) alpha *= mean(mesh_->alphas, 1, 0);
    return alpha < material_->alpha_cutoff;
}

Rgb MeshPlace::emission() const {
    Rgb radiance = material_->emission;
    if (material_->emission_map) {
        const Rgb texel = sample(material_->emission_map);
        for (std::size_t i = 0; i < 3; ++i) radiance[i] *= texel[i];
    }
    return radiance;
}

std::array<double, 2> MeshPlace::roughness_metallic() const {
    std::array<double, 2> result{material_->roughness, material_->metallic};
    if (material_->metallic_roughness_map) {
        const Rgb texel = sample(material_->metallic_roughness_map);
        result[0] *= texel[1];
        result[1] *= texel[2];
    }
    return result;
}

std::optional<Vector3> MeshPlace::interpolated_normal() const {
    if (mesh_->normals.empty()) return std::nullopt;
    Vector3 sum(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector3 normal = corner_normal(k);
        if (normal == Vector3(0.0)) return std::nullopt;
        sum += weights_[k] * normal;
    }
    const double length = glm::length(sum);
    if (!(length > 1e-6)) return std::nullopt;
    return sum / length;
}

Vector3 MeshPlace::turn_side(const Vector3& flat) const {
    std::array<Vector3, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) {
        const float* at = &mesh_->positions[3 * std::size_t{corners_[k]}];
        p[k] = Vector3(at[0], at[1], at[2]);
    }
    const Vector3 across = glm::cross(in_world(p[1] - p[0]), in_world(p[2] - p[0]));
    // A mirrored copy has its corners in the opposite order.
    const bool is_mirror = transform_ != nullptr && transform_->is_mirror;
    return (glm::dot(across, flat) < 0) != is_mirror ? -flat : flat;
}

Vector3 MeshPlace::bent(const Vector3& normal) const {
    const TextureUse& use = material_->normal_map;
    const Rgb texel = sample(use);
    const double scale = material_->normal_scale;
    const Vector3 local(scale * (2 * texel[0] - 1), scale * (2 * texel[1] - 1), 2 * texel[2] - 1);
    Vector3 tangent(0.0), up(0.0);
    double side = 1;
    bool has_all = !mesh_->tangents.empty();
    for (std::size_t k = 0; has_all && k < 3; ++k) {
        const Vector3 corner = corner_tangent(k);
        has_all = corner != Vector3(0.0);
        tangent += weights_[k] * corner;
    }
    if (has_all) {
        side = mean(mesh_->tangents, 4, 3) < 0 ? -1 : 1;
        if (transform_ != nullptr && transform_->is_mirror) side = -side;
    } else {
        UvAxes axes;
        if (!uv_axes(*mesh_, corners_, use, axes)) return normal;
        tangent = in_world(axes.u_axis);
        side = glm::dot(glm::cross(normal, tangent), in_world(axes.up_axis)) < 0 ? -1 : 1;
    }
    tangent -= glm::dot(tangent, normal) * normal;
    const double length = glm::length(tangent);
    if (!(length > 0) || !std::isfinite(length)) return normal;
    tangent /= length;
    up = side * glm::cross(normal, tangent);
    const Vector3 result = local.x * tangent + local.y * up + local.z * normal;
    const double size = glm::length(result);
    return size > 1e-6 && local.z > 0 ? result / size : normal;
}

Vector3 MeshPlace::shading_normal(const Vector3& flat) const {
    const std::optional<Vector3> interpolated = interpolated_normal();
    if (!material_->normal_map) {
        if (!interpolated) return flat;
        return glm::dot(*interpolated, flat) < 0 ? -*interpolated : *interpolated;
    }
    // The map is defined for the front: the side of the file's normals, or that of the winding
    // order.
    const Vector3 front = interpolated ? *interpolated : turn_side(flat);
    // From behind, bumps appear as dents.
    Vector3 normal = glm::dot(front, flat) < 0 ? -bent(front) : bent(front);
    const double toward = glm::dot(normal, flat);
    if (toward < 0) normal = glm::normalize(normal - toward * flat);
    return normal;
}

Vector3 toward_viewer(const Vector3& normal, const Vector3& direction) {
    return glm::dot(normal, direction) > 0 ? -normal : normal;
}

/// The colour given in the scene, or that of the file.
Spectrum base_color(const MeshObject& object, const MeshPlace& place,
                    const ReflectanceBands& bands) {
    return object.reflectance ? *object.reflectance : bands.from_rgb(place.base_color());
}

/// Fills the members that depend on textures, except the material. The geometric normal is given.
void shade_with_textures(const MeshObject& object, const MeshPlace& place,
                         const ReflectanceBands& bands, SurfaceHit& hit) {
    hit.normal = place.shading_normal(hit.geometric_normal);
    hit.reflectance = base_color(object, place, bands);
    if (!object.is_pbr) return;
    const double metallic = place.roughness_metallic()[1];
    for (double& rho : hit.reflectance) rho *= 1 - metallic;
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
    const Vector3 extent(glm::length(rows[0]), glm::length(rows[1]), glm::length(rows[2]));
    bounds.extend(middle - radius * extent);
    bounds.extend(middle + radius * extent);
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
    shade_with_textures(object, place, bands, hit);
    hit.has_material = object.is_pbr || place.material().emission != Rgb{0, 0, 0};
    hit.triangle = triangle;
    hit.u = crossing.u;
    hit.v = crossing.v;
    hit.object_id = mesh.object_id(triangle);
    const std::uint32_t number = place.material().number;
    hit.material_id = number == 0 ? 0 : object.materials_end + number;
}

bool is_textured_mesh(const PlacedMesh& mesh, std::uint32_t triangle) {
    if (!mesh.object.has_textures) return false;
    const auto& shape = mesh.object.mesh;
    const MeshMaterial& material =
        shape.materials[shape.triangle_materials.empty() ? 0 : shape.triangle_materials[triangle]];
    return material.base_map || material.normal_map || material.metallic_roughness_map;
}

void filter_mesh(const PlacedMesh& mesh, const ReflectanceBands& bands, const SurfaceSpread& spread,
                 SurfaceHit& hit) {
    if (!mesh.object.has_textures) return;
    const MeshPlace place(mesh.object.mesh, hit.triangle, hit.u, hit.v, mesh.transform(), spread);
    shade_with_textures(mesh.object, place, bands, hit);
    hit.spread = spread;
}

void add_to_texture_of_mesh(const PlacedMesh& mesh, const ReflectanceBands& bands,
                            const SurfaceHit& hit, std::span<const double> by_reflectance,
                            TextureGradient& gradient) {
    const MeshObject& object = mesh.object;
    if (!object.has_textures || object.reflectance) return;
    const MeshPlace place(object.mesh, hit.triangle, hit.u, hit.v, mesh.transform(), hit.spread);
    place.add_base_color(bands.by_rgb(by_reflectance), gradient);
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
