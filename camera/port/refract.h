#pragma once

#include <optional>

#include "core/base/vec.h"
#include "core/scene/camera_desc.h"

namespace uw {

/// Snell's law in vector form (docs/physics.md, section 3): `direction` (unit) crosses from index
/// `n1` to `n2` through a surface whose unit `normal` points the way the light goes (direction .
/// normal > 0). Unit result; empty on total reflection. Nothing is singular at normal incidence,
/// and equal indices leave the direction as it is.
std::optional<Vector3> refract(const Vector3& direction, const Vector3& normal, double n1,
                               double n2);

/// The cosines to a port's normals at which a ray meets its surfaces.
struct PortCosines {
    double inner_air = 1;    // in air, at the inner surface
    double outer_glass = 1;  // in glass, at the outer surface
};

/// The factor between the radiance in water and what arrives at the camera, as the port's
/// description requests: Fresnel's transmittance for unpolarised light through both surfaces,
/// without inter-reflections in the glass, and (n_air / n_water)^2 if the radiance is requested in
/// air. 1 if neither is. Both surfaces share their plane of incidence, so each polarisation is
/// transmitted by itself.
template <class PortDescription>
double port_transmittance(const PortDescription& port, const PortCosines& cosines);

extern template double port_transmittance(const FlatPortDesc&, const PortCosines&);
extern template double port_transmittance(const DomePortDesc&, const PortCosines&);

}  // namespace uw
