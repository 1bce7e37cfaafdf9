#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/base/vec.h"
#include "core/meshes/mesh.h"

namespace uw {

/// A point on a triangle of a mesh, for evaluating textures, vertex colours and normals.
class MeshPlace {
  public:
    /// Barycentric u and v: (1 - u - v) a + u b + v c; clamped to the triangle. Refers to `mesh`.
    MeshPlace(const TriangleMesh& mesh, std::uint32_t triangle, double u, double v);

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
    /// side too: at grazing angles an interpolated normal may point away from the viewer.
    Vector3 shading_normal(const Vector3& flat) const;

  private:
    Rgb sample(const TextureUse& use) const;
    /// Weighted means over the corners.
    double mean(const std::vector<float>& values, std::size_t width, std::size_t component) const;
    Vector3 mean_vector(const std::vector<float>& values, std::size_t width) const;
    /// From the vertex normals; empty if a corner has none.
    std::optional<Vector3> interpolated_normal() const;
    /// `flat` on the side from which the corners appear counter-clockwise.
    Vector3 turn_side(const Vector3& flat) const;
    /// `normal`, on the file's side of the surface, perturbed by the normal map.
    Vector3 bent(const Vector3& normal) const;

    const TriangleMesh* mesh_;
    const MeshMaterial* material_;
    const std::uint32_t* corners_;
    std::array<double, 3> weights_;
};

}  // namespace uw
