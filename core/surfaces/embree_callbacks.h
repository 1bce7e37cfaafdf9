#pragma once

#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>

#include "core/surfaces/embree_api.h"
#include "core/surfaces/scene_objects.h"

/// What Embree calls back while it follows rays, one or several at a time; with Embree's header in
/// it, this is for embree_*.cpp only.
namespace uw {

/// Share of a shadow ray at either end that belongs to the surfaces it joins.
inline constexpr double k_end_margin = 1e-5;
inline bool between_ends(double t) {
    return t > k_end_margin && t < 1 - k_end_margin;
}

/// A ray on its way through Embree, and the nearest candidate that the callbacks took for it. The
/// candidate is to be read from here: Embree's own record may be of a farther one.
struct Query {
    Point3 origin;
    Vector3 direction{0.0};
    float t = std::numeric_limits<float>::infinity();
    float u = 0, v = 0;  // of meshes
    unsigned geometry = RTC_INVALID_GEOMETRY_ID, primitive = RTC_INVALID_GEOMETRY_ID;
    bool has_doubt = false;  // an occluder was passed over

    bool has_candidate() const { return geometry != RTC_INVALID_GEOMETRY_ID; }

    /// Takes a candidate unless a nearer one, or an equally near one of lower number, is known.
    bool take(float its_t, unsigned its_geometry, unsigned its_primitive) {
        if (std::tie(its_t, its_geometry, its_primitive) >= std::tie(t, geometry, primitive)) {
            return false;
        }
        t = its_t;
        geometry = its_geometry;
        primitive = its_primitive;
        return true;
    }
};

/// What the callbacks get back as their context: the queries under way. The id of each of Embree's
/// rays is the place of its query.
struct QueryContext {
    embree::Context context;  // first, so that a pointer to one is a pointer to the other
    Query* queries = nullptr;
    /// Whether occluders met near the edge of a triangle count (embree_rays.h); without this they
    /// are passed over.
    bool edges_count = false;

    explicit QueryContext(Query* first) : context(embree::make_context()), queries(first) {}
};
static_assert(std::is_standard_layout_v<QueryContext>);

/// Filter of triangles for the closest hit; settles ties.
void filter_closest(const RTCFilterFunctionNArguments* args);
/// Filter of triangles for shadow rays; the geometry's user data is its MeshObject.
void filter_occluder(const RTCFilterFunctionNArguments* args);
/// The same for meshes with holes (MeshObject::has_holes), which cost a texture look-up each.
void filter_closest_with_holes(const RTCFilterFunctionNArguments* args);
void filter_occluder_with_holes(const RTCFilterFunctionNArguments* args);

// The user geometry of spheres; its user data is a std::vector<SphereObject>.
void sphere_bounds(const RTCBoundsFunctionArguments* args);
void intersect_sphere(const RTCIntersectFunctionNArguments* args);
void occlude_sphere(const RTCOccludedFunctionNArguments* args);

}  // namespace uw
