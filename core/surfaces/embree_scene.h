#pragma once

#include <memory>
#include <type_traits>

#include "core/surfaces/embree_callbacks.h"

namespace uw {

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
    /// Builds what the scene holds.
    void commit(RTCScene scene) const;
    void check(const char* doing) const;

    const SceneObjects& objects_;
    Device device_;
    Scene scene_;
};

}  // namespace uw
