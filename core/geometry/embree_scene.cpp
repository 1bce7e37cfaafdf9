#include "core/geometry/embree_scene.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <map>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"

namespace uw {

namespace {

/// Passed to the callbacks as their context: the queries in progress. The id of each Embree ray is
/// the index of its query.
struct QueryContext {
    embree::Context context;  // first, so that a pointer to one is a pointer to the other
    Query* queries = nullptr;
    const SceneObjects* objects = nullptr;
    /// Whether occluders hit near the edge of a triangle count (trace_edges); otherwise they are
    /// skipped.
    bool edges_count = false;

    QueryContext(const TracedScene& traced, Query* first)
        : context(embree::make_context()), queries(first), objects(traced.objects) {}
};
static_assert(std::is_standard_layout_v<QueryContext>);

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

/// Triangle filter for the closest hit; resolves ties.
void filter_closest(const RTCFilterFunctionNArguments* args) {
    take_closest<false>(args);
}

/// The same for meshes with holes (MeshObject::has_holes), which cost a texture look-up each.
void filter_closest_with_holes(const RTCFilterFunctionNArguments* args) {
    take_closest<true>(args);
}

/// Triangle filter for shadow rays.
void filter_occluder(const RTCFilterFunctionNArguments* args) {
    take_occluder<false>(args);
}

void filter_occluder_with_holes(const RTCFilterFunctionNArguments* args) {
    take_occluder<true>(args);
}

// The user geometry of spheres; its user data is a std::vector<SphereObject>.
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

namespace {

// The memory of a triangle in Embree's structure, measured with 10^7 of them while it is built.
constexpr double k_bytes_per_triangle = 100;

void check_memory(const SceneObjects& objects) {
    std::uint64_t triangles = 0;
    for (const auto* meshes : {&objects.meshes, &objects.shared_meshes})
        for (const auto& object : *meshes) triangles += object->mesh.triangle_count();
    require_memory(k_bytes_per_triangle * static_cast<double>(triangles),
                   fmt::format("geometry: to trace {} triangles takes", triangles),
                   "simplify the meshes");
}

// The progress callback, which Embree calls from any of its threads while it builds.
bool goes_on(void* stop, double /*progress*/) {
    return !static_cast<const std::atomic<bool>*>(stop)->load(std::memory_order_relaxed);
}

}  // namespace

EmbreeScene::EmbreeScene(const SceneObjects& objects)
    : objects_(objects),
      device_(rtcNewDevice(nullptr), &rtcReleaseDevice),
      scene_(nullptr, &rtcReleaseScene) {
    check_memory(objects_);
    if (!device_ && rtcGetDeviceError(nullptr) == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (!device_) throw std::runtime_error("Embree cannot start on this processor");
    scene_ = new_scene();
    for (const auto& mesh : objects_.meshes) attach(scene_.get(), *mesh);
    attach_instances();
    if (!objects_.spheres.empty()) attach_spheres();
    commit(scene_.get());
}

void EmbreeScene::check(const char* doing) const {
    const RTCError error = rtcGetDeviceError(device_.get());
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_CANCELLED) throw Interrupted();
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    throw std::runtime_error(std::string("Embree failed while ") + doing + ": error " +
                             std::to_string(error));
}

void EmbreeScene::commit(RTCScene scene) const {
    const std::atomic<bool>* const stop = StopScope::of_this_thread();
    if (stop != nullptr)  // which Embree takes as non-const, and goes_on only reads
        rtcSetSceneProgressMonitorFunction(scene, goes_on, const_cast<std::atomic<bool>*>(stop));
    rtcCommitScene(scene);
    rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
    try {
        check("building the acceleration structure");
    } catch (const Interrupted&) {
        throw;
    } catch (...) {
        // Never freed: if memory runs out, tasks of the build may remain, and freeing the scene
        // would wait for them forever, or call std::terminate.
        rtcRetainScene(scene);
        throw;
    }
}

EmbreeScene::Scene EmbreeScene::new_scene() const {
    Scene scene(rtcNewScene(device_.get()), &rtcReleaseScene);
    // Robust: no ray slips between two triangles that share an edge.
    rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
    return scene;
}

EmbreeScene::Geometry EmbreeScene::new_geometry(RTCGeometryType type) const {
    return {rtcNewGeometry(device_.get(), type), &rtcReleaseGeometry};
}

void EmbreeScene::attach(RTCScene scene, const MeshObject& object) const {
    const Geometry geometry = new_geometry(RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               object.mesh.positions.data(), 0, 3 * sizeof(float),
                               object.vertex_count);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               object.mesh.triangles.data(), 0, 3 * sizeof(std::uint32_t),
                               object.mesh.triangle_count());
    rtcSetGeometryIntersectFilterFunction(
        geometry.get(), object.has_holes ? filter_closest_with_holes : filter_closest);
    rtcSetGeometryOccludedFilterFunction(
        geometry.get(), object.has_holes ? filter_occluder_with_holes : filter_occluder);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene, geometry.get());
    check("taking over a mesh");
}

void EmbreeScene::attach_instances() const {
    std::map<const MeshObject*, Scene> scenes;
    for (const auto& shared : objects_.shared_meshes) {
        Scene scene = new_scene();
        attach(scene.get(), *shared);
        commit(scene.get());
        scenes.emplace(shared.get(), std::move(scene));
    }
    for (const MeshInstance& instance : objects_.instances) {
        const Geometry geometry = new_geometry(RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry.get(), scenes.at(instance.object).get());
        const Affine& map = instance.transform.world_from_mesh;
        std::array<float, 12> columns{};  // three of the linear part, then the offset
        for (int column = 0; column < 4; ++column) {
            const Vector3 values = column < 3 ? map.linear()[column] : map.offset();
            for (int row = 0; row < 3; ++row) {
                const int place = 3 * column + row;
                columns[static_cast<std::size_t>(place)] = static_cast<float>(values[row]);
            }
        }
        rtcSetGeometryTransform(geometry.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
                                columns.data());
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene_.get(), geometry.get());
    }
    check("taking over instances");
}

void EmbreeScene::attach_spheres() const {
    const Geometry geometry = new_geometry(RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry.get(),
                                     static_cast<unsigned>(objects_.spheres.size()));
    // Embree's callbacks take it as non-const, ours only read it.
    rtcSetGeometryUserData(geometry.get(),
                           const_cast<std::vector<SphereObject>*>(&objects_.spheres));
    rtcSetGeometryBoundsFunction(geometry.get(), sphere_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry.get(), intersect_sphere);
    rtcSetGeometryOccludedFunction(geometry.get(), occlude_sphere);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene_.get(), geometry.get());
    check("taking over the spheres");
}
}  // namespace uw
