#include "core/embree_callbacks.h"

#include <cmath>

namespace uw {

void filter_closest(const RTCFilterFunctionNArguments* args) {
    auto* query = reinterpret_cast<Query*>(args->context);
    if (!query->take(RTCRayN_tfar(args->ray, 1, 0), RTCHitN_geomID(args->hit, 1, 0),
                     RTCHitN_primID(args->hit, 1, 0))) {
        args->valid[0] = 0;
    }
}

void filter_occluder(const RTCFilterFunctionNArguments* args) {
    const auto* query = reinterpret_cast<const Query*>(args->context);
    const auto& object = *static_cast<const MeshObject*>(args->geometryUserPtr);
    const auto crossing =
        cross_triangle(object, RTCHitN_primID(args->hit, 1, 0), query->origin, query->direction);
    const double t = crossing ? crossing->t : RTCRayN_tfar(args->ray, 1, 0);
    if (!between_ends(t)) args->valid[0] = 0;
}

void sphere_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& spheres = *static_cast<const std::vector<SphereObject>*>(args->geometryUserPtr);
    const Bounds bounds = spheres[args->primID].world_bounds();
    float* lower = &args->bounds_o->lower_x;
    float* upper = &args->bounds_o->upper_x;
    for (int axis = 0; axis < 3; ++axis) {
        // Outwards by more than the rounding of the box and of the ray that is tried on it.
        const double margin =
            1e-6 * (std::abs(bounds.min[axis]) + std::abs(bounds.max[axis])) + 1e-30;
        lower[axis] = static_cast<float>(bounds.min[axis] - margin);
        upper[axis] = static_cast<float>(bounds.max[axis] + margin);
    }
}

void intersect_sphere(const RTCIntersectFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    auto* query = reinterpret_cast<Query*>(args->context);
    const auto& spheres = *static_cast<const std::vector<SphereObject>*>(args->geometryUserPtr);
    RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, 1);
    RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, 1);
    const auto roots = cross_sphere(spheres[args->primID], query->origin, query->direction);
    if (!roots) return;
    const double begin = RTCRayN_tnear(ray, 1, 0);
    const double t = roots->near > begin ? roots->near : roots->far;
    const auto candidate = static_cast<float>(t);
    if (!(t > begin) || candidate > RTCRayN_tfar(ray, 1, 0)) return;
    if (!query->take(candidate, args->geomID, args->primID)) return;
    RTCRayN_tfar(ray, 1, 0) = candidate;
    RTCHitN_geomID(hit, 1, 0) = args->geomID;
    RTCHitN_primID(hit, 1, 0) = args->primID;
}

void occlude_sphere(const RTCOccludedFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    const auto* query = reinterpret_cast<const Query*>(args->context);
    const auto& spheres = *static_cast<const std::vector<SphereObject>*>(args->geometryUserPtr);
    const auto roots = cross_sphere(spheres[args->primID], query->origin, query->direction);
    if (roots && (between_ends(roots->near) || between_ends(roots->far))) {
        RTCRayN_tfar(args->ray, 1, 0) = -std::numeric_limits<float>::infinity();
    }
}

}  // namespace uw
