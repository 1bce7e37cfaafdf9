#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/ray.h"
#include "core/base/vector_math.h"

namespace uw {

/// The orientation of a lamp in the world, which places its profile.
struct LampPlacement {
    Affine world_from_frame;     // of the camera, or of another mount; rigid
    Vector3 direction{0, 0, 1};  // in which the lamp shines, in this frame, unit

    /// The direction from which angles about the lamp's direction are counted, in the frame, unit:
    /// the frame's x axis (y if the lamp shines along x), projected onto the perpendicular plane.
    Vector3 across() const {
        const Vector3 x(1, 0, 0), y(0, 1, 0);
        const Vector3& reference = glm::length(glm::cross(direction, x)) > 1e-6 ? x : y;
        return glm::normalize(reference - glm::dot(reference, direction) * direction);
    }
    /// The direction in which the lamp shines, world, unit.
    Vector3 axis() const { return glm::normalize(world_from_frame.apply_to_vector(direction)); }
    /// That of `across`, turned by `rotate` [degrees] about the lamp's direction, anticlockwise
    /// seen from behind the lamp; world, unit.
    Vector3 across_in_world(double rotate) const {
        const Vector3 from = across(), up = glm::cross(-direction, from);
        const double turn = glm::radians(rotate);
        return glm::normalize(
            world_from_frame.apply_to_vector(std::cos(turn) * from + std::sin(turn) * up));
    }
};

/// The directions within an angle of an axis.
struct DirectionCone {
    Vector3 axis{0, 0, 1};  // unit
    double cosine = -1;     // of the angle; -1: all directions

    bool has_all() const { return cosine <= -1; }
    /// `direction`: of any length.
    bool has(const Vector3& direction) const {
        if (has_all()) return true;  // regardless of rounding
        const double along = glm::dot(direction, axis);
        const double edge = cosine * cosine * glm::dot(direction, direction);  // of along^2
        return cosine >= 0 ? along >= 0 && along * along >= edge
                           : along >= 0 || along * along <= edge;
    }
    /// All directions within `angle` [rad] of a direction in this cone.
    DirectionCone widened(double angle) const;
    bool includes(const DirectionCone& other) const;
};

/// What of a profile is narrower than its cone, so that rays a few pixels apart may miss its light.
struct FineStructure {
    bool is_everywhere = false;     // the light is a pattern
    std::optional<Vector3> normal;  // unit; it is a sheet, thin when seen along its plane
};

/// Crossings of a ray with the surfaces at which a lamp's profile may have breaks, all through the
/// lamp (`apex`). Each function appends distances > 0 along `ray`, in no particular order, and none
/// where there is no crossing.

/// The cone of half-angle acos(`cos_angle`) about `axis` (unit).
void append_cone_crossings(const Ray& ray, const Point3& apex, const Vector3& axis,
                           double cos_angle, std::vector<double>& s);

/// The plane perpendicular to `normal`.
void append_plane_crossing(const Ray& ray, const Point3& apex, const Vector3& normal,
                           std::vector<double>& s);

/// The half of the plane perpendicular to `normal` that lies towards `side`.
void append_half_plane_crossing(const Ray& ray, const Point3& apex, const Vector3& side,
                                const Vector3& normal, std::vector<double>& s);

/// The point of an interval of a ray at which the angle to a beam's axis is least.
struct AxisApproach {
    double s = 0;        // distance along the ray
    double cosine = -1;  // of the angle at the beam's apex
};

/// Finds where the angle between `interval` and `axis` (unit) at `apex` is least.
AxisApproach approach_to_axis(const Ray& ray, const Interval& interval, const Point3& apex,
                              const Vector3& axis);

/// Appends where the angle to `axis` (unit) at `apex` is least or greatest: the azimuth changes
/// fastest there, and a profile peaked on its axis has a kink.
void append_nearest_to_axis(const Ray& ray, const Point3& apex, const Vector3& axis,
                            std::vector<double>& s);

/// The part of `interval` between the first and the last of the `cuts` beside which `is_lit(point)`
/// holds halfway to the next one; of length 0 if it holds nowhere. Cuts outside count for nothing.
template <typename IsLit>
Interval lit_part(const Ray& ray, const Interval& interval, std::vector<double>& cuts,
                  const IsLit& is_lit) {
    std::erase_if(cuts, [&](double s) { return s <= interval.begin || s >= interval.end; });
    cuts.push_back(interval.begin);
    cuts.push_back(interval.end);
    std::sort(cuts.begin(), cuts.end());
    Interval lit{interval.begin, interval.begin};
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        if (!is_lit(ray.at(0.5 * (cuts[i] + cuts[i + 1])))) continue;
        if (lit.length() == 0) lit.begin = cuts[i];
        lit.end = cuts[i + 1];
    }
    return lit;
}

}  // namespace uw
