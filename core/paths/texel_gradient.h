#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/texture.h"
#include "core/geometry/textured_surfaces.h"
#include "core/paths/contribution_gradient.h"

namespace uw {

/// The derivatives of a number by the texels of a texture that diffuse surfaces reflect by, from
/// those by the light of paths. Texels that reflect nothing have none: no path goes by them.
class TexelGradient final : public ContributionGradient {
  public:
    /// `surfaces` must outlive it, as must the texture.
    TexelGradient(const TexturedSurfaces& surfaces, const Texture& texture, std::size_t bands)
        : surfaces_(surfaces), gradient_(texture), bands_(bands) {}

    int add_vertex(int before, const PathVertex& vertex) override;
    void add(const PathContribution& term, std::span<const double> worth) override;
    void finish() override;

    /// TextureGradient::by_texel.
    std::vector<double> by_texel() const { return gradient_.by_texel(); }

  private:
    struct Corner {
        int before = k_no_vertex;
        bool is_reflection = false;
        SurfaceHit hit;
        std::vector<double> worth;  // by band, of all terms by way of here
    };
    // Light of this worth is reflected at `hit`.
    void add_reflection(const SurfaceHit& hit, std::span<const double> worth);

    const TexturedSurfaces& surfaces_;
    TextureGradient gradient_;
    std::size_t bands_;
    std::vector<Corner> corners_;  // reused
    std::size_t count_ = 0;
};

}  // namespace uw
