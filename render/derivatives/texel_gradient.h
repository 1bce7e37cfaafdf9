#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/texture.h"
#include "core/geometry/textured_surfaces.h"
#include "render/derivatives/contribution_gradient.h"

namespace uw {

/// The derivatives of a scalar by the texels of a texture of diffuse reflectance, given its
/// derivatives by the contributions of light paths. Black texels have none, as no path goes through
/// them.
class TexelGradient final : public ContributionGradient {
  public:
    /// `surfaces` and the texture must outlive this object.
    TexelGradient(const TexturedSurfaces& surfaces, const Texture& texture, std::size_t bands)
        : surfaces_(surfaces), gradient_(texture), bands_(bands) {}

    int add_vertex(int before, const PathVertex& vertex) override;
    void add(const PathContribution& contribution, std::span<const double> sensitivity) override;
    void finish() override;

    /// As TextureGradient::by_texel.
    std::vector<double> by_texel() const { return gradient_.by_texel(); }

  private:
    struct Vertex {
        int before = k_no_vertex;
        bool is_reflection = false;
        SurfaceHit hit;
        std::vector<double> sensitivity;  // by band, of all contributions through this vertex
    };
    // Adds the derivative by the reflectance at `hit`.
    void add_reflection(const SurfaceHit& hit, std::span<const double> sensitivity);

    const TexturedSurfaces& surfaces_;
    TextureGradient gradient_;
    std::size_t bands_;
    std::vector<Vertex> vertices_;  // reused
    std::size_t count_ = 0;
};

}  // namespace uw
