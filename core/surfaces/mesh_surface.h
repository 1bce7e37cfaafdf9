#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/base/vec.h"
#include "core/meshes/mesh.h"

namespace uw {

/// A place on a triangle of a mesh: what textures, vertex colours and normals are there.
class MeshPlace {
  public:
    /// Barycentric u and v: (1 - u - v) a + u b + v c; brought into the triangle. Refers to `mesh`.
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

    /// The interpolated normal of the file, or the flat one if a corner has none, bent by the
    /// normal map. `flat` is the triangle's, on the viewer's side, and the result is on that side,
    /// too: on a grazing view an interpolated one may lean past the viewer's horizon.
    Vector3 shading_normal(const Vector3& flat) const;

  private:
    Rgb sample(const TextureUse& use) const;
    /// Means of the corners, by the weights.
    double mean(const std::vector<float>& values, std::size_t width, std::size_t component) const;
    Vector3 mean_vector(const std::vector<float>& values, std::size_t width) const;
    /// Of the file; none where a corner has none.
    std::optional<Vector3> interpolated_normal() const;
    /// `flat` on the side from which the corners turn counter-clockwise.
    Vector3 turn_side(const Vector3& flat) const;
    /// `normal`, on the file's side of the surface, bent by the normal map.
    Vector3 bent(const Vector3& normal) const;

    const TriangleMesh* mesh_;
    const MeshMaterial* material_;
    const std::uint32_t* corners_;
    std::array<double, 3> weights_;
};

}  // namespace uw
