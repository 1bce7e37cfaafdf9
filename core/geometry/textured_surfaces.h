#pragma once

#include "core/base/vector_math.h"
#include "core/geometry/surfaces.h"

namespace uw {

/// The parallelogram of a surface that a hit stands for, around it: between the tangents at the
/// hit, in world space [m]. Both zero: the hit is a point.
struct SurfaceSpread {
    Vector3 across{0.0}, down{0.0};
};

/// Surfaces of which some have textures. What is hit is shaded at a point; who knows that a hit
/// stands for more than that has its textures taken over all of it.
class TexturedSurfaces {
  public:
    virtual ~TexturedSurfaces() = default;

    virtual bool has_textures() const = 0;
    /// Replaces what textures give to a hit of these surfaces, its reflectance and shading normal,
    /// by their means over `spread`. Where that covers less than a texel nothing changes, and
    /// neither does what Surfaces::material says.
    virtual void filter_textures(const SurfaceSpread& spread, SurfaceHit& hit) const = 0;
};

/// The same surfaces if they have textures, else null.
inline const TexturedSurfaces* textures_of(const Surfaces& surfaces) {
    const auto* const textured = dynamic_cast<const TexturedSurfaces*>(&surfaces);
    return textured != nullptr && textured->has_textures() ? textured : nullptr;
}

}  // namespace uw
