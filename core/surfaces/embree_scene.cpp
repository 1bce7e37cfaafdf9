#include "core/surfaces/embree_scene.h"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/base/available_memory.h"
#include "core/base/error.h"
#include "core/base/stop.h"

namespace uw {
namespace {

// Of a triangle in Embree's structure, measured with 10^7 of them while it is built.
constexpr double k_bytes_per_triangle = 100;

void check_memory(const SceneObjects& objects) {
    std::uint64_t triangles = 0;
    for (const auto* meshes : {&objects.meshes, &objects.shared_meshes})
        for (const auto& object : *meshes) triangles += object->mesh.triangle_count();
    require_memory(k_bytes_per_triangle * static_cast<double>(triangles),
                   fmt::format("geometry: to trace {} triangles takes", triangles),
                   "simplify the meshes");
}

// What Embree asks, from any of its threads, while it builds.
bool goes_on(void* stop, double /*share*/) {
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
    const std::string reason =
        error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : "error " + std::to_string(error);
    throw std::runtime_error(std::string("Embree failed while ") + doing + ": " + reason);
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
        // Never freed: where memory runs out, tasks of the building may be left behind, and to free
        // the scene is to wait for them for ever, or std::terminate.
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
                columns[static_cast<std::size_t>(3 * column + row)] =
                    static_cast<float>(values[row]);
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
