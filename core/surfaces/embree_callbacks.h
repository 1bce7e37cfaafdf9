#pragma once

#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>

#include "core/surfaces/embree_api.h"
#include "core/surfaces/scene_objects.h"

/// Embree's callbacks during traversal, for one or several rays at a time. Includes Embree's
/// header, so for embree_*.cpp only.
namespace uw {

/// Fraction of a shadow ray at either end that belongs to the surfaces it connects.
inline constexpr double k_end_margin = 1e-5;
inline bool between_ends(double t) {
    return t > k_end_margin && t < 1 - k_end_margin;
}

/// A ray during traversal, and the nearest candidate that the callbacks have accepted. The
/// candidate must be read from here: Embree's own record may hold a farther one.
struct Query {
    Point3 origin;
    Vector3 direction{0.0};
    float t = std::numeric_limits<float>::infinity();
    float u = 0, v = 0;  // of meshes
    /// In the traced scene: of an instance its own, not that of its mesh.
    unsigned geometry = RTC_INVALID_GEOMETRY_ID, primitive = RTC_INVALID_GEOMETRY_ID;
    bool has_doubt = false;  // an occluder was skipped

    bool has_candidate() const { return geometry != RTC_INVALID_GEOMETRY_ID; }

    /// Accepts a candidate unless a nearer one, or an equally near one with a lower number, is
    /// known.
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

/// Embree's structure over the objects of a scene. Its geometries are numbered as
/// SceneObjects::placed, the spheres last.
struct TracedScene {
    RTCScene scene = nullptr;
    const SceneObjects* objects = nullptr;
};

/// Passed to the callbacks as their context: the queries in progress. The id of each Embree ray is
/// the index of its query.
struct QueryContext {
    embree::Context context;  // first, so that a pointer to one is a pointer to the other
    Query* queries = nullptr;
    const SceneObjects* objects = nullptr;
    /// Whether occluders hit near the edge of a triangle count (embree_rays.h); otherwise they are
    /// skipped.
    bool edges_count = false;

    QueryContext(const TracedScene& traced, Query* first)
        : context(embree::make_context()), queries(first), objects(traced.objects) {}
};
static_assert(std::is_standard_layout_v<QueryContext>);

/// Triangle filter for the closest hit; resolves ties.
void filter_closest(const RTCFilterFunctionNArguments* args);
/// Triangle filter for shadow rays.
void filter_occluder(const RTCFilterFunctionNArguments* args);
/// The same for meshes with holes (MeshObject::has_holes), which cost a texture look-up each.
void filter_closest_with_holes(const RTCFilterFunctionNArguments* args);
void filter_occluder_with_holes(const RTCFilterFunctionNArguments* args);

// The user geometry of spheres; its user data is a std::vector<SphereObject>.
void sphere_bounds(const RTCBoundsFunctionArguments* args);
void intersect_sphere(const RTCIntersectFunctionNArguments* args);
void occlude_sphere(const RTCOccludedFunctionNArguments* args);

}  // namespace uw
