#pragma once

#include <span>

#include "core/geometry/surfaces.h"

namespace uw {

class TextureGradient;  // core/geometry/texture.h

/// Surfaces of which some have textures. A hit is shaded at a point; a caller that knows its
/// footprint can have the textures filtered over it.
class TexturedSurfaces {
  public:
    virtual ~TexturedSurfaces() = default;

    virtual bool has_textures() const = 0;
    /// Whether a hit is on a surface whose texture affects its reflectance or its normal.
    virtual bool is_textured(const SurfaceHit& hit) const = 0;
    /// Replaces the reflectance and shading normal of a hit, where they come from textures, by
    /// their means over `spread`. If that covers less than a texel nothing changes; the result of
    /// Surfaces::material never does.
    virtual void filter_textures(const SurfaceSpread& spread, SurfaceHit& hit) const = 0;
    /// Propagates the derivatives of a number by the reflectance of a hit, by band, back to the
    /// texels from which it was computed, if they are those of the gradient's texture.
    virtual void add_to_texture(const SurfaceHit& hit, std::span<const double> by_reflectance,
                                TextureGradient& gradient) const = 0;
};

/// The same surfaces if they have textures, else null.
inline const TexturedSurfaces* textures_of(const Surfaces& surfaces) {
    const auto* const textured = dynamic_cast<const TexturedSurfaces*>(&surfaces);
    return textured != nullptr && textured->has_textures() ? textured : nullptr;
}

}  // namespace uw
