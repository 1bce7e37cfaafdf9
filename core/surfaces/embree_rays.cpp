#include "core/surfaces/embree_rays.h"

#include <cassert>

namespace uw {
namespace {

/// Slightly too far, so that nothing is lost to rounding; the double-precision distance decides.
float embree_end(double end) {
    return end < 1e30 ? static_cast<float>(end * (1 + 1e-6)) : 1e30F;
}

RTCRay embree_ray(const Query& query, float begin, double end) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(query.origin.x);
    ray.org_y = static_cast<float>(query.origin.y);
    ray.org_z = static_cast<float>(query.origin.z);
    ray.dir_x = static_cast<float>(query.direction.x);
    ray.dir_y = static_cast<float>(query.direction.y);
    ray.dir_z = static_cast<float>(query.direction.z);
    ray.tnear = begin;
    ray.tfar = embree_end(end);
    ray.mask = ~0U;
    return ray;
}

/// Which lanes of a packet are active, in Embree's format.
struct alignas(32) Places {
    int taken[k_packet_size] = {};
};

void put(RTCRay8& rays, Places& places, std::size_t i, const Query& query, float begin,
         double end) {
    const RTCRay ray = embree_ray(query, begin, end);
    rays.org_x[i] = ray.org_x;
    rays.org_y[i] = ray.org_y;
    rays.org_z[i] = ray.org_z;
    rays.dir_x[i] = ray.dir_x;
    rays.dir_y[i] = ray.dir_y;
    rays.dir_z[i] = ray.dir_z;
    rays.tnear[i] = ray.tnear;
    rays.tfar[i] = ray.tfar;
    rays.mask[i] = ray.mask;
    rays.id[i] = static_cast<unsigned>(i);
    places.taken[i] = -1;
}

void trace_packet(const TracedScene& traced, std::span<Query> queries, float begin,
                  std::span<const double> ends) {
    assert(queries.size() <= k_packet_size && queries.size() == ends.size());
    QueryContext context(traced, queries.data());
    RTCRayHit8 rayhits{};
    Places places;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        put(rayhits.ray, places, i, queries[i], begin, ends[i]);
        rayhits.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    embree::intersect8(places.taken, traced.scene, context.context, rayhits);
}

unsigned occluded_packet(const TracedScene& traced, std::span<Query> queries, bool edges_count) {
    assert(queries.size() <= k_packet_size);
    QueryContext context(traced, queries.data());
    context.edges_count = edges_count;
    RTCRay8 rays{};
    Places places;
    for (std::size_t i = 0; i < queries.size(); ++i) put(rays, places, i, queries[i], 0, 1);
    embree::occluded8(places.taken, traced.scene, context.context, rays);
    unsigned occluded = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        if (rays.tfar[i] < 0) occluded |= 1U << i;
    }
    return occluded;
}

}  // namespace

void trace(const TracedScene& traced, Query& query, float begin, double end) {
    QueryContext context(traced, &query);
    RTCRayHit rayhit{};
    rayhit.ray = embree_ray(query, begin, end);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree::intersect1(traced.scene, context.context, rayhit);
}

void trace_edges(const TracedScene& traced, Query& query, float begin, double end) {
    trace_packet(traced, std::span(&query, 1), begin, std::span(&end, 1));
}

void trace_packet(const TracedScene& traced, std::span<Query> queries,
                  std::span<const double> ends) {
    trace_packet(traced, queries, 0, ends);
}

bool is_occluded(const TracedScene& traced, Query& query) {
    query.has_doubt = false;
    QueryContext context(traced, &query);
    RTCRay ray = embree_ray(query, 0, 1);
    embree::occluded1(traced.scene, context.context, ray);
    if (ray.tfar < 0 || !query.has_doubt) return ray.tfar < 0;
    return occluded_packet(traced, std::span(&query, 1), true) != 0;
}

unsigned occluded_packet(const TracedScene& traced, std::span<Query> queries) {
    unsigned occluded = occluded_packet(traced, queries, false);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const bool open = (occluded >> i & 1U) == 0 && queries[i].has_doubt;
        if (open && is_occluded(traced, queries[i])) occluded |= 1U << i;
    }
    return occluded;
}

}  // namespace uw
