#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <tuple>
#include <type_traits>

#include "core/geometry/embree_api.h"
#include "core/geometry/scene_objects.h"

namespace uw {

/// Embree's callbacks during traversal, for one or several rays at a time. Includes Embree's
/// header, so for embree_*.cpp only.

/// Fraction of a shadow ray at either end that belongs to the surfaces it connects.
inline constexpr double k_end_margin = 1e-5;
inline bool between_ends(double t) {
    return t > k_end_margin && t < 1 - k_end_margin;
}

/// A ray during traversal, and the nearest candidate that the callbacks have accepted. The
/// candidate must be read from here: Embree's own record may be of a farther one.
struct Query {
    Point3 origin;
    Vector3 direction{0.0};
    float t = std::numeric_limits<float>::infinity();
    float u = 0, v = 0;  // of meshes
    /// In the traced scene; for an instance its own, not that of its mesh.
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

/// Traces queries with Embree, one at a time or as packets of coherent rays; for embree_*.cpp only.
///
/// All variants find every triangle that a ray hits well inside (TriangleCrossing), with
/// bit-identical results. Near an edge, however, rounding decides whether a ray enters the boxes
/// around a triangle, and each variant rounds differently; a packet also tests a ray against
/// triangles in boxes that only its neighbours enter. Hits near an edge are therefore decided by a
/// single variant: a packet of one ray. As it hits nothing that a larger packet with that ray would
/// miss, the results equal those of single queries even where a packet hits nothing at all.

/// The greatest number of queries in a packet.
inline constexpr std::size_t k_packet_size = 8;

/// Finds the nearest candidate of `query` between the parameters `begin` and `end`.
void trace(const TracedScene& traced, Query& query, float begin, double end);

/// The same as a packet of one.
void trace_edges(const TracedScene& traced, Query& query, float begin, double end);

/// The same for a packet, from 0 to the end of each.
void trace_packet(const TracedScene& traced, std::span<Query> queries,
                  std::span<const double> ends);

/// Whether a mesh or sphere lies between the parameters 0 and 1, with hits near edges resolved.
bool is_occluded(const TracedScene& traced, Query& query);

/// The same for a packet: bit i of the result is that of query i.
unsigned occluded_packet(const TracedScene& traced, std::span<Query> queries);

/// Embree's acceleration structure over the meshes, instances and spheres of a scene, numbered as
/// TracedScene says; for embree_*.cpp only.
class EmbreeScene {
  public:
    /// Refers to `objects`, whose vertices it does not copy. Throws InputError if they do not fit
    /// into free memory, Interrupted, and std::runtime_error with Embree's message.
    explicit EmbreeScene(const SceneObjects& objects);

    TracedScene traced() const { return {scene_.get(), &objects_}; }

  private:
    using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, decltype(&rtcReleaseDevice)>;
    using Scene = std::unique_ptr<std::remove_pointer_t<RTCScene>, decltype(&rtcReleaseScene)>;
    using Geometry =
        std::unique_ptr<std::remove_pointer_t<RTCGeometry>, decltype(&rtcReleaseGeometry)>;

    Scene new_scene() const;
    Geometry new_geometry(RTCGeometryType type) const;
    void attach(RTCScene scene, const MeshObject& object) const;
    void attach_instances() const;
    void attach_spheres() const;
    /// Builds the structure over the scene's objects.
    void commit(RTCScene scene) const;
    void check(const char* doing) const;

    const SceneObjects& objects_;
    Device device_;
    Scene scene_;
};
}  // namespace uw
