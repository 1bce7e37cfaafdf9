#pragma once

#include <span>

#include "core/geometry/surfaces.h"

namespace uw {

class TextureGradient;  // core/geometry/texture.h

/// Surfaces of which some have textures. What is hit is shaded at a point; who knows that a hit
/// stands for more than that has its textures taken over all of it.
class TexturedSurfaces {
  public:
    virtual ~TexturedSurfaces() = default;

    virtual bool has_textures() const = 0;
    /// Whether a hit of these surfaces is where one of them has a texture that shows in its
    /// reflectance or its normal.
    virtual bool is_textured(const SurfaceHit& hit) const = 0;
    /// Replaces what textures give to a hit of these surfaces, its reflectance and shading normal,
    /// by their means over `spread`. Where that covers less than a texel nothing changes, and
    /// neither does what Surfaces::material says.
    virtual void filter_textures(const SurfaceSpread& spread, SurfaceHit& hit) const = 0;
    /// Hands the derivatives of a number by the reflectance of a hit, by band, back to the texels
    /// that it was taken from, if they are those of the gradient's texture.
    virtual void add_to_texture(const SurfaceHit& hit, std::span<const double> by_reflectance,
                                TextureGradient& gradient) const = 0;
};

/// The same surfaces if they have textures, else null.
inline const TexturedSurfaces* textures_of(const Surfaces& surfaces) {
    const auto* const textured = dynamic_cast<const TexturedSurfaces*>(&surfaces);
    return textured != nullptr && textured->has_textures() ? textured : nullptr;
}

}  // namespace uw
