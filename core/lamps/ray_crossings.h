#pragma once

#include <vector>

#include "core/base/ray.h"

/// Where a ray crosses what a lamp's profile may break at, all of it with its apex at the lamp.
/// Each appends distances > 0 along `ray`, in no order, none where it never does.
namespace uw {

/// The cone of half-angle acos(`cos_angle`) about `axis` (unit).
void append_cone_crossings(const Ray& ray, const Point3& apex, const Vector3& axis,
                           double cos_angle, std::vector<double>& s);

/// The plane across `normal`.
void append_plane_crossing(const Ray& ray, const Point3& apex, const Vector3& normal,
                           std::vector<double>& s);

/// The half of the plane across `normal` that lies on the side of `side`.
void append_half_plane_crossing(const Ray& ray, const Point3& apex, const Vector3& side,
                                const Vector3& normal, std::vector<double>& s);

/// Where the angle to `axis` (unit), seen from `apex`, is least or greatest: the azimuth changes
/// fastest there, and a profile with a tip on its axis bends.
void append_nearest_to_axis(const Ray& ray, const Point3& apex, const Vector3& axis,
                            std::vector<double>& s);

}  // namespace uw
