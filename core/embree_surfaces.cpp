#include "core/embree_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/embree_callbacks.h"

namespace uw {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
/// A closest hit at or behind the origin is passed over this often: a camera in a surface's plane.
constexpr int k_max_restarts = 16;

using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, decltype(&rtcReleaseDevice)>;
using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, decltype(&rtcReleaseScene)>;
using Geometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, decltype(&rtcReleaseGeometry)>;

RTCRay embree_ray(const Point3& origin, const Vector3& direction, float begin, double end) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(origin.x);
    ray.org_y = static_cast<float>(origin.y);
    ray.org_z = static_cast<float>(origin.z);
    ray.dir_x = static_cast<float>(direction.x);
    ray.dir_y = static_cast<float>(direction.y);
    ray.dir_z = static_cast<float>(direction.z);
    ray.tnear = begin;
    // A little far, so that nothing is lost to rounding; the double distance decides.
    ray.tfar = end < 1e30 ? static_cast<float>(end * (1 + 1e-6)) : 1e30F;
    ray.mask = ~0U;
    return ray;
}

class EmbreeSurfaces final : public Surfaces {
  public:
    explicit EmbreeSurfaces(SceneObjects objects)
        : objects_(std::move(objects)),
          device_(rtcNewDevice(nullptr), &rtcReleaseDevice),
          scene_(nullptr, &rtcReleaseScene) {
        if (!device_) throw std::runtime_error("Embree cannot start on this processor");
        scene_.reset(rtcNewScene(device_.get()));
        // Robust: no ray slips between two triangles that share an edge.
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        for (const auto& mesh : objects_.meshes) attach(*mesh);
        if (!objects_.spheres.empty()) attach_spheres();
        rtcCommitScene(scene_.get());
        check("building the acceleration structure");
    }

    bool closest_hit(const Ray& ray, double s_end, SurfaceHit& hit) const override {
        const Candidate nearest = find_nearest(ray, s_end);
        if (!(nearest.distance <= s_end) || nearest.distance == k_infinity) return false;
        hit.distance = nearest.distance;
        hit.position = ray.at(nearest.distance);
        if (nearest.plane != nullptr) {
            shade_plane(*nearest.plane, ray.direction, hit);
        } else if (nearest.geometry < objects_.meshes.size()) {
            shade_mesh(*objects_.meshes[nearest.geometry], nearest.primitive, nearest.crossing,
                       objects_.bands, ray.direction, hit);
        } else {
            shade_sphere(objects_.spheres[nearest.primitive], ray.direction, hit);
        }
        return true;
    }

    double hit_distance(const Ray& ray) const override {
        return find_nearest(ray, k_infinity).distance;
    }

    bool occluded(const Point3& from, const Point3& to) const override {
        // One order of the ends for both directions, so that light and view rays agree exactly.
        const bool forward = std::tie(from.x, from.y, from.z) < std::tie(to.x, to.y, to.z);
        const Point3& begin = forward ? from : to;
        const Vector3 along = (forward ? to : from) - begin;
        if (along == Vector3(0.0)) return false;
        for (const PlaneObject& plane : objects_.planes) {
            const auto t = cross_plane(plane, begin, along);
            if (t && between_ends(*t)) return true;
        }
        Query query(begin, along);
        RTCRay ray = embree_ray(begin, along, 0, 1);
        rtcOccluded1(scene_.get(), &query.context, &ray);
        return ray.tfar < 0;
    }

    Bounds bounds() const override { return objects_.bounds; }

    std::uint64_t triangle_count() const override {
        std::uint64_t count = 0;
        for (const auto& object : objects_.meshes) count += object->mesh.triangle_count();
        return count;
    }

    bool empty() const override {
        return objects_.meshes.empty() && objects_.spheres.empty() && objects_.planes.empty();
    }

  private:
    struct Candidate {
        double distance = k_infinity;
        const PlaneObject* plane = nullptr;  // if set, the rest means nothing
        unsigned geometry = 0, primitive = 0;
        TriangleCrossing crossing;  // of meshes
    };

    void check(const char* doing) const {
        const RTCError error = rtcGetDeviceError(device_.get());
        if (error == RTC_ERROR_NONE) return;
        const std::string reason =
            error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : "error " + std::to_string(error);
        throw std::runtime_error(std::string("Embree failed while ") + doing + ": " + reason);
    }

    void attach(MeshObject& object) {
        const Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE),
                                &rtcReleaseGeometry);
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   object.mesh.positions.data(), 0, 3 * sizeof(float),
                                   object.vertex_count);
        rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   object.mesh.triangles.data(), 0, 3 * sizeof(std::uint32_t),
                                   object.mesh.triangle_count());
        rtcSetGeometryUserData(geometry.get(), &object);
        rtcSetGeometryIntersectFilterFunction(geometry.get(), filter_closest);
        rtcSetGeometryOccludedFilterFunction(geometry.get(), filter_occluder);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene_.get(), geometry.get());
        check("taking over a mesh");
    }

    void attach_spheres() {
        const Geometry geometry(rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER),
                                &rtcReleaseGeometry);
        rtcSetGeometryUserPrimitiveCount(geometry.get(),
                                         static_cast<unsigned>(objects_.spheres.size()));
        rtcSetGeometryUserData(geometry.get(), &objects_.spheres);
        rtcSetGeometryBoundsFunction(geometry.get(), sphere_bounds, nullptr);
        rtcSetGeometryIntersectFunction(geometry.get(), intersect_sphere);
        rtcSetGeometryOccludedFunction(geometry.get(), occlude_sphere);
        rtcCommitGeometry(geometry.get());
        rtcAttachGeometry(scene_.get(), geometry.get());
        check("taking over the spheres");
    }

    /// The nearest mesh or sphere, not necessarily within `s_end`.
    Candidate trace(const Ray& ray, double s_end) const {
        float begin = 0;
        for (int restart = 0; restart < k_max_restarts; ++restart) {
            Query query(ray.origin, ray.direction);
            RTCRayHit rayhit{};
            rayhit.ray = embree_ray(ray.origin, ray.direction, begin, s_end);
            rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene_.get(), &query.context, &rayhit);
            if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
            const Candidate candidate = refine(ray, rayhit);
            if (candidate.distance > 0) return candidate;
            begin = std::nextafter(rayhit.ray.tfar, std::numeric_limits<float>::infinity());
        }
        return {};
    }

    /// Embree's hit, measured in double.
    Candidate refine(const Ray& ray, const RTCRayHit& rayhit) const {
        Candidate candidate;
        candidate.geometry = rayhit.hit.geomID;
        candidate.primitive = rayhit.hit.primID;
        const double coarse = rayhit.ray.tfar;
        if (candidate.geometry < objects_.meshes.size()) {
            const auto crossing = cross_triangle(*objects_.meshes[candidate.geometry],
                                                 candidate.primitive, ray.origin, ray.direction);
            candidate.crossing =
                crossing ? *crossing : TriangleCrossing{coarse, rayhit.hit.u, rayhit.hit.v};
            candidate.distance = candidate.crossing.t;
            return candidate;
        }
        const auto roots =
            cross_sphere(objects_.spheres[candidate.primitive], ray.origin, ray.direction);
        // The callback found these roots; the one it took is the nearer to what it wrote.
        const bool near = std::abs(roots->near - coarse) <= std::abs(roots->far - coarse);
        candidate.distance = near ? roots->near : roots->far;
        return candidate;
    }

    Candidate find_nearest(const Ray& ray, double s_end) const {
        Candidate nearest;
        for (const PlaneObject& plane : objects_.planes) {
            const auto t = cross_plane(plane, ray.origin, ray.direction);
            if (!t || !(*t > 0) || *t >= nearest.distance) continue;
            nearest.distance = *t;
            nearest.plane = &plane;
        }
        const Candidate traced = trace(ray, std::min(s_end, nearest.distance));
        return traced.distance < nearest.distance ? traced : nearest;
    }

    SceneObjects objects_;
    Device device_;
    Scene scene_;
};

}  // namespace

std::unique_ptr<Surfaces> make_embree_surfaces(SceneObjects objects) {
    return std::make_unique<EmbreeSurfaces>(std::move(objects));
}

}  // namespace uw
