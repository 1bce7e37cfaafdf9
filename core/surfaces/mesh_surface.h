#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/base/vec.h"
#include "core/meshes/mesh.h"
#include "core/surfaces/mesh_transform.h"

namespace uw {

/// A point on a triangle of a mesh, for evaluating textures, vertex colours and normals.
class MeshPlace {
  public:
    /// Barycentric u and v: (1 - u - v) a + u b + v c; clamped to the triangle. Refers to `mesh`,
    /// and to the transform of a mesh that is not in world space.
    MeshPlace(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v,
              const MeshTransform* transform = nullptr);

    const MeshMaterial& material() const { return *material_; }
    /// Linear RGB 0..1.
    Rgb base_color() const;
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
};

}  // namespace uw
