#pragma once

#include <embree3/rtcore.h>

#include <limits>
#include <tuple>
#include <type_traits>

#include "core/scene_objects.h"

/// What Embree calls back while it follows a ray; with Embree's header in it, this is for
/// embree_*.cpp only. Rays go one at a time (N == 1).
namespace uw {

/// Share of a shadow ray at either end that belongs to the surfaces it joins.
inline constexpr double k_end_margin = 1e-5;
inline bool between_ends(double t) {
    return t > k_end_margin && t < 1 - k_end_margin;
}

/// A ray on its way through Embree; callbacks get it back as their context.
struct Query {
    RTCIntersectContext context{};  // first, so that a pointer to one is a pointer to the other
    Point3 origin;
    Vector3 direction;
    float best_t = std::numeric_limits<float>::infinity();
    unsigned best_geometry = RTC_INVALID_GEOMETRY_ID, best_primitive = RTC_INVALID_GEOMETRY_ID;

    Query(const Point3& from, const Vector3& along) : origin(from), direction(along) {
        rtcInitIntersectContext(&context);
    }

    /// Takes a candidate unless a nearer one, or an equally near one of lower number, is known.
    bool take(float t, unsigned geometry, unsigned primitive) {
        if (std::tie(t, geometry, primitive) >= std::tie(best_t, best_geometry, best_primitive)) {
            return false;
        }
        best_t = t;
        best_geometry = geometry;
        best_primitive = primitive;
        return true;
    }
};
static_assert(std::is_standard_layout_v<Query>);

/// Filter of triangles for the closest hit; settles ties.
void filter_closest(const RTCFilterFunctionNArguments* args);
/// Filter of triangles for shadow rays; the geometry's user data is its MeshObject.
void filter_occluder(const RTCFilterFunctionNArguments* args);

// The user geometry of spheres; its user data is a std::vector<SphereObject>.
void sphere_bounds(const RTCBoundsFunctionArguments* args);
void intersect_sphere(const RTCIntersectFunctionNArguments* args);
void occlude_sphere(const RTCOccludedFunctionNArguments* args);

}  // namespace uw
