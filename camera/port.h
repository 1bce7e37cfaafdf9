#pragma once

#include <memory>
#include <optional>

#include "core/base/ray.h"
#include "core/base/vector_math.h"
#include "core/scene/camera_desc.h"

namespace uw {

/// The glass between the camera's air and the water, without a rim (docs/physics.md, section 3).
/// All points and directions are in the camera frame; the camera's centre is its origin. Thread
/// safe.
class Port {
  public:
    virtual ~Port() = default;

    /// The ray in water that leaves the camera centre along `direction` (unit, in air). Its origin
    /// lies on the outer glass surface. Empty if the ray does not meet the glass, or is totally
    /// reflected at either surface.
    std::optional<Ray> refracted_ray(const Vector3& direction) const {
        return refracted_ray(Point3{}, direction);
    }
    /// The ray in water that leaves the point `from` of the housing, otherwise as above.
    virtual std::optional<Ray> refracted_ray(const Point3& from,
                                             const Vector3& direction) const = 0;

    /// The factor between the radiance in water and what arrives at the camera centre along
    /// `direction` (unit, in air), as the description requests: Fresnel's transmittance for
    /// unpolarised light through both surfaces, without inter-reflections in the glass, and (n_air
    /// / n_water)^2 if the radiance is requested in air. 1 if neither is; 0 without a water ray if
    /// the light is totally reflected.
    virtual double transmittance(const Vector3& direction) const = 0;

    /// The unit direction in air, from the camera centre, of the ray that meets `point` in the
    /// water; empty if none does, as for points in the housing or in the glass.
    virtual std::optional<Vector3> direction_to(const Point3& point) const = 0;
};

/// The port of a description: a flat window, two parallel planes n.X = d and n.X = d + d_g, or a
/// dome, two concentric spheres inside which the camera centre lies, not necessarily at their
/// centre. Precondition: the camera centre lies within a dome's inner sphere.
std::shared_ptr<const Port> make_port(const PortDesc& desc);

/// The ray in water of one in the housing, camera frame; without a port (null), that ray itself.
inline std::optional<Ray> through_port(const Port* port, const Ray& in_housing) {
    if (port == nullptr) return in_housing;
    return port->refracted_ray(in_housing.origin, in_housing.direction);
}

}  // namespace uw
