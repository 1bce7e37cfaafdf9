#pragma once

#include <optional>

#include "core/base/ray.h"
#include "core/scene/camera_desc.h"

namespace uw {

/// A flat window between the camera's air and the water: two parallel planes n.X = d and
/// n.X = d + d_g in the camera frame. It has no rim.
class FlatPort {
  public:
    explicit FlatPort(const FlatPortDesc& desc) : desc_(desc) {}

    /// The ray in water, camera frame, that leaves the camera centre along `direction` (unit, in
    /// air). Its origin lies on the outer glass surface. Empty if the ray runs away from or along
    /// the glass, or is totally reflected at either surface.
    std::optional<Ray> refracted_ray(const Vector3& direction) const {
        return refracted_ray(Point3{}, direction);
    }
    /// The same from any point in the housing.
    std::optional<Ray> refracted_ray(const Point3& from, const Vector3& direction) const;

    /// The factor between the radiance in water and what arrives at the camera centre along
    /// `direction` (unit, in air), as the description requests: Fresnel's transmittance for
    /// unpolarised light through both surfaces, without inter-reflections in the glass, and (n_air
    /// / n_water)^2 if the radiance is requested in air. 1 if neither is. Precondition: there is a
    /// water ray.
    double transmittance(const Vector3& direction) const;

    /// The unit direction in air, from the camera centre, of the ray that meets `point` (camera
    /// frame) in the water; empty if none does, as for points in the housing or in the glass.
    /// Refraction stays in the plane of the normal and the point, where the ray's distance from the
    /// normal at the point's depth increases with its slope: one monotone equation (Agrawal et al.
    /// 2012), solved to the last digits.
    std::optional<Vector3> direction_to(const Point3& point) const;

  private:
    FlatPortDesc desc_;
};

}  // namespace uw
