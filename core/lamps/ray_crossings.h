#pragma once

#include <vector>

#include "core/base/ray.h"

/// Crossings of a ray with the surfaces at which a lamp's profile may have breaks, all through the
/// lamp (`apex`). Each function appends distances > 0 along `ray`, in no particular order, and none
/// where there is no crossing.
namespace uw {

/// The cone of half-angle acos(`cos_angle`) about `axis` (unit).
void append_cone_crossings(const Ray& ray, const Point3& apex, const Vector3& axis,
                           double cos_angle, std::vector<double>& s);

/// The plane perpendicular to `normal`.
void append_plane_crossing(const Ray& ray, const Point3& apex, const Vector3& normal,
                           std::vector<double>& s);

/// The half of the plane perpendicular to `normal` that lies towards `side`.
void append_half_plane_crossing(const Ray& ray, const Point3& apex, const Vector3& side,
                                const Vector3& normal, std::vector<double>& s);

/// Where on a stretch of a ray the angle to a beam's axis is least.
struct AxisApproach {
    double s = 0;        // distance along the ray
    double cosine = -1;  // of the angle, seen from the beam's apex
};

/// That of `stretch` to `axis` (unit), seen from `apex`.
AxisApproach approach_to_axis(const Ray& ray, const Interval& stretch, const Point3& apex,
                              const Vector3& axis);

/// Where the angle to `axis` (unit), seen from `apex`, is least or greatest: the azimuth changes
/// fastest there, and a profile peaked on its axis has a kink.
void append_nearest_to_axis(const Ray& ray, const Point3& apex, const Vector3& axis,
                            std::vector<double>& s);

}  // namespace uw
