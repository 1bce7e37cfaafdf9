#pragma once

#include <optional>
#include <variant>

#include "core/base/ray.h"
#include "core/base/vector_math.h"
#include "core/scene/camera_desc.h"

namespace uw {

/// The fraction of energy that a smooth surface transmits, for light polarised perpendicular (s)
/// and parallel (p) to the plane of incidence.
struct FresnelTransmittance {
    double s = 1;
    double p = 1;
};

/// Fresnel's equations between two transparent media (docs/physics.md, section 3): light meets the
/// surface from index `n1` with cosine `cos1` (0..1) to its normal and continues in index `n2`.
/// Energy, so 1 - s and 1 - p are reflected, and the reverse path has the same values. 0 on total
/// reflection and at grazing incidence.
FresnelTransmittance fresnel_transmittance(double cos1, double n1, double n2);

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

/// A spherical window between the camera's air and the water: two concentric spheres in the camera
/// frame, inside which the camera centre lies, not necessarily at their centre. It has no rim: rays
/// leave in all directions.
class DomePort {
  public:
    /// Precondition: the camera centre lies within the inner sphere.
    explicit DomePort(const DomePortDesc& desc) : desc_(desc) {}

    /// The ray in water, camera frame, that leaves the camera centre along `direction` (unit, in
    /// air). Its origin lies on the outer glass surface. Empty if the ray is totally reflected at
    /// either surface, which happens only if air or glass is optically denser than what follows.
    std::optional<Ray> refracted_ray(const Vector3& direction) const {
        return refracted_ray(Point3{}, direction);
    }
    /// The same from any point within the inner sphere.
    std::optional<Ray> refracted_ray(const Point3& from, const Vector3& direction) const;

    /// As FlatPort::transmittance.
    double transmittance(const Vector3& direction) const;

    /// The unit direction in air, from the camera centre, of the ray that meets `point` (camera
    /// frame) in the water; empty if none does, as for points inside the outer sphere. A ray stays
    /// in the plane of the spheres' centre, the camera and the point, and n r sin(i), with i its
    /// angle to the radius r, is constant along it (Bouguer's law): one equation for the angle that
    /// the ray sweeps around the centre, solved to the last digits.
    std::optional<Vector3> direction_to(const Point3& point) const;

  private:
    /// The path through the glass: where a ray leaves it, and its direction in the water.
    struct Passage {
        Vector3 outer;  // from the spheres' centre
        Vector3 in_water{0, 0, 1};
        double inner_air = 1, outer_glass = 1;  // cosines to the normals
    };
    std::optional<Passage> passage(const Point3& from, const Vector3& direction) const;

    DomePortDesc desc_;
};

/// The glass between camera and water. All have `refracted_ray`, `transmittance` and
/// `direction_to`.
using Port = std::variant<FlatPort, DomePort>;

inline Port make_port(const PortDesc& desc) {
    if (const auto* dome = std::get_if<DomePortDesc>(&desc)) return DomePort(*dome);
    return FlatPort(std::get<FlatPortDesc>(desc));
}

/// The ray in water of one in the housing, camera frame; without a port, that ray itself.
inline std::optional<Ray> through_port(const std::optional<Port>& port, const Ray& in_housing) {
    if (!port) return in_housing;
    return std::visit(
        [&](const auto& glass) {
            return glass.refracted_ray(in_housing.origin, in_housing.direction);
        },
        *port);
}

}  // namespace uw
