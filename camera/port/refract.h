#pragma once

#include <optional>

#include "core/base/vec.h"
#include "core/scene/camera_desc.h"

namespace uw {

/// Snell's law in vector form (docs/physics.md, section 3): `direction` (unit) crosses from index
/// `n1` to `n2` through a surface whose unit `normal` points the way the light goes
/// (direction . normal > 0). Unit result; empty on total reflection. Nothing is
/// singular at normal incidence, and equal indices change nothing.
std::optional<Vector3> refract(const Vector3& direction, const Vector3& normal, double n1,
                               double n2);

/// The cosines to a port's normals at which a ray meets its surfaces.
struct PortCosines {
    double inner_air = 1;    // in air, at the inner surface
    double outer_glass = 1;  // in glass, at the outer surface
};

/// What a port's glass makes of the radiance in water on its way to the camera, as its description
/// asks: Fresnel's transmittance of unpolarised light through both surfaces, without the light
/// that is reflected to and fro in the glass, and (n_air / n_water)^2 where the radiance is asked
/// for in air. 1 if neither is. Both surfaces share their plane of incidence: what the first
/// polarises meets the second so.
template <class PortDescription>
double port_transmittance(const PortDescription& port, const PortCosines& cosines);

extern template double port_transmittance(const FlatPortDesc&, const PortCosines&);
extern template double port_transmittance(const DomePortDesc&, const PortCosines&);

}  // namespace uw
