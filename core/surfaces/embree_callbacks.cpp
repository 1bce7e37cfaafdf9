#include "core/surfaces/embree_callbacks.h"

#include <cmath>

namespace uw {
namespace {

/// How far behind the nearest candidate Embree continues to search, as a fraction of the distance:
/// more than the rounding of its boxes, so that it finds all candidates of a tie, whatever their
/// order and however many rays it traces at once.
constexpr float k_tie_margin = 4e-6F;

float search_end(float nearest) {
    return nearest * (1 + k_tie_margin);
}

const QueryContext& context_of(const embree::Context* context) {
    return *reinterpret_cast<const QueryContext*>(context);
}

Query& query_of(const embree::Context* context, RTCRayN* rays, unsigned count, unsigned i) {
    return context_of(context).queries[RTCRayN_id(rays, count, i)];
}

/// The number of the mesh that Embree found, SceneObjects::placed.
unsigned number_of(const RTCFilterFunctionNArguments* args, unsigned i) {
    const unsigned instance = RTCHitN_instID(args->hit, args->N, i, 0);
    return instance != RTC_INVALID_GEOMETRY_ID ? instance : RTCHitN_geomID(args->hit, args->N, i);
}

PlacedMesh mesh_of(const RTCFilterFunctionNArguments* args, unsigned i) {
    return context_of(args->context).objects->placed(number_of(args, i));
}

/// Whether the ray of `query` passes through a hole of the mesh where Embree found a triangle hit.
bool passes_hole(const PlacedMesh& mesh, const RTCFilterFunctionNArguments* args, unsigned i,
                 const Query& query) {
    const unsigned count = args->N;
    const unsigned triangle = RTCHitN_primID(args->hit, count, i);
    // In double precision, like the crossing reported later.
    const auto crossing = cross_triangle(mesh, triangle, query.origin, query.direction);
    return mesh.object.is_hole(triangle, crossing
                                             ? *crossing
                                             : TriangleCrossing{0, RTCHitN_u(args->hit, count, i),
                                                                RTCHitN_v(args->hit, count, i)});
}

template <bool with_holes>
void take_closest(const RTCFilterFunctionNArguments* args) {
    const unsigned count = args->N;
    for (unsigned i = 0; i < count; ++i) {
        if (args->valid[i] != -1) continue;
        Query& query = query_of(args->context, args->ray, count, i);
        if constexpr (with_holes) {
            if (passes_hole(mesh_of(args, i), args, i, query)) {
                args->valid[i] = 0;
                continue;
            }
        }
        float& end = RTCRayN_tfar(args->ray, count, i);  // here the candidate's own
        if (query.take(end, number_of(args, i), RTCHitN_primID(args->hit, count, i))) {
            query.u = RTCHitN_u(args->hit, count, i);
            query.v = RTCHitN_v(args->hit, count, i);
            end = search_end(end);
        } else {
            args->valid[i] = 0;
        }
    }
}

template <bool with_holes>
void take_occluder(const RTCFilterFunctionNArguments* args) {
    const unsigned count = args->N;
    for (unsigned i = 0; i < count; ++i) {
        if (args->valid[i] != -1) continue;
        Query& query = query_of(args->context, args->ray, count, i);
        const PlacedMesh mesh = mesh_of(args, i);
        const auto crossing = cross_triangle(mesh, RTCHitN_primID(args->hit, count, i),
                                             query.origin, query.direction);
        const double t = crossing ? crossing->t : RTCRayN_tfar(args->ray, count, i);
        if (!between_ends(t) || (with_holes && passes_hole(mesh, args, i, query))) {
            args->valid[i] = 0;
        } else if (!context_of(args->context).edges_count &&
                   !(crossing && crossing->well_inside())) {
            query.has_doubt = true;
            args->valid[i] = 0;
        }
    }
}

}  // namespace

void filter_closest(const RTCFilterFunctionNArguments* args) {
    take_closest<false>(args);
}

void filter_closest_with_holes(const RTCFilterFunctionNArguments* args) {
    take_closest<true>(args);
}

void filter_occluder(const RTCFilterFunctionNArguments* args) {
    take_occluder<false>(args);
}

void filter_occluder_with_holes(const RTCFilterFunctionNArguments* args) {
    take_occluder<true>(args);
}

void sphere_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& spheres = *static_cast<const std::vector<SphereObject>*>(args->geometryUserPtr);
    const Bounds bounds = spheres[args->primID].world_bounds();
    float* lower = &args->bounds_o->lower_x;
    float* upper = &args->bounds_o->upper_x;
    for (int axis = 0; axis < 3; ++axis) {
        // Enlarged by more than the rounding of the box and of the ray tested against it.
        const double margin =
            1e-6 * (std::abs(bounds.min[axis]) + std::abs(bounds.max[axis])) + 1e-30;
        lower[axis] = static_cast<float>(bounds.min[axis] - margin);
        upper[axis] = static_cast<float>(bounds.max[axis] + margin);
    }
}

void intersect_sphere(const RTCIntersectFunctionNArguments* args) {
    const auto& spheres = *static_cast<const std::vector<SphereObject>*>(args->geometryUserPtr);
    const unsigned count = args->N;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, count);
    for (unsigned i = 0; i < count; ++i) {
        if (args->valid[i] != -1) continue;
        Query& query = query_of(args->context, rays, count, i);
        const auto roots = cross_sphere(spheres[args->primID], query.origin, query.direction);
        if (!roots) continue;
        const double begin = RTCRayN_tnear(rays, count, i);
        const double t = roots->near > begin ? roots->near : roots->far;
        const auto candidate = static_cast<float>(t);
        float& end = RTCRayN_tfar(rays, count, i);
        if (!(t > begin) || candidate > end) continue;
        if (query.take(candidate, args->geomID, args->primID)) end = search_end(candidate);
    }
}

void occlude_sphere(const RTCOccludedFunctionNArguments* args) {
    const auto& spheres = *static_cast<const std::vector<SphereObject>*>(args->geometryUserPtr);
    const unsigned count = args->N;
    for (unsigned i = 0; i < count; ++i) {
        if (args->valid[i] != -1) continue;
        const Query& query = query_of(args->context, args->ray, count, i);
        const auto roots = cross_sphere(spheres[args->primID], query.origin, query.direction);
        if (roots && (between_ends(roots->near) || between_ends(roots->far))) {
            RTCRayN_tfar(args->ray, count, i) = -std::numeric_limits<float>::infinity();
        }
    }
}

}  // namespace uw
