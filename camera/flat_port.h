#pragma once

#include <optional>

#include "core/ray.h"
#include "core/scene_desc.h"

namespace uw {

/// Snell's law in vector form (docs/physics.md, section 3): `direction` (unit) crosses from index
/// `n1` to `n2` through a surface whose unit `normal` points the way the light goes
/// (direction . normal > 0). Unit result; empty on total reflection. Nothing is
/// singular at normal incidence, and equal indices change nothing.
std::optional<Vector3> refract(const Vector3& direction, const Vector3& normal, double n1,
                               double n2);

/// A flat window between the camera's air and the water: two parallel planes n.X = d and
/// n.X = d + d_g in the camera frame. It has no rim.
class FlatPort {
  public:
    explicit FlatPort(const FlatPortDesc& desc) : desc_(desc) {}

    /// The ray in water, camera frame, that leaves the camera centre along `direction` (unit, in
    /// air). Its origin lies on the outer glass surface. Empty if the ray runs away from or along
    /// the glass, or is totally reflected at either surface.
    std::optional<Ray> water_ray(const Vector3& direction) const;

    /// What the port makes of the radiance in water on its way to the camera centre along
    /// `direction` (unit, in air), as the description asks: Fresnel's transmittance of unpolarised
    /// light through both surfaces, without the light that is reflected to and fro in the glass,
    /// and (n_air / n_water)^2 where the radiance is asked for in air. 1 if neither is.
    /// Precondition: there is a water ray.
    double transmittance(const Vector3& direction) const;

  private:
    FlatPortDesc desc_;
};

}  // namespace uw
