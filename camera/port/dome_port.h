#pragma once

#include <optional>

#include "core/base/ray.h"
#include "core/scene/camera_desc.h"

namespace uw {

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

}  // namespace uw
