#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/geometry/surfaces.h"
#include "core/passes/pixel_view.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// A point of the world in a camera's image.
struct SeenPoint {
    static constexpr double k_none = std::numeric_limits<double>::quiet_NaN();

    ImagePoint pixel{k_none, k_none};  // NaN if no ray leads to the point
    double path = k_none;              // in the water, along its ray [m]
    bool in_image = false;
    bool visible = false;  // in the image and not hidden by a surface
};

/// Whether a position lies within the camera's image, including its edges.
bool is_in_image(const ImagePoint& pixel, const Camera& camera);

/// Projects a point through lens and port (Camera::project). A point of NaN is not visible.
SeenPoint seen_point(const Point3& world, const Camera& camera, const Surfaces& surfaces);

/// The motion of an object's points to another time, in world space.
struct ObjectMotion {
    Affine map;  ///< of a rigid object
    /// If it deforms: x, y, z of its mesh's vertices then [m], and of those of all objects of its
    /// file that deform (GltfMoment).
    std::shared_ptr<const std::vector<float>> vertices;
};

/// The motion of each object of a scene, by id from 1; none for an object whose points have no
/// counterpart at the other time.
using ObjectMotions = std::vector<std::optional<ObjectMotion>>;

/// Where the point of a hit on `surfaces` is at the other time: of a deforming object, the same
/// point of the same triangle. None without a counterpart. `motions`: empty if nothing moves.
std::optional<Point3> moved_point(const ObjectMotions& motions, const Surfaces& surfaces,
                                  const SurfaceHit& hit);

/// Finds points in the image of another camera, at another time, or both.
class ViewMatcher final : public PointMatcher {
  public:
    /// `own`: the surfaces that are hit. `motions`: those of the objects to which the points
    /// belong; empty if none moves. `surfaces`: those at the other time; null if it does not matter
    /// whether a point is hidden.
    ViewMatcher(Camera camera, std::shared_ptr<const Surfaces> own, ObjectMotions motions,
                std::shared_ptr<const Surfaces> surfaces);

    void match(std::span<const SurfaceHit* const> hits,
               std::span<std::optional<PointMatch>> matches) const override;

  private:
    Camera camera_;
    std::shared_ptr<const Surfaces> own_;
    ObjectMotions motions_;
    std::shared_ptr<const Surfaces> surfaces_;
};

/// Returns the motions of the objects `names` of the scene `now` to `then`, another of its frames,
/// by their trajectories and by the animations, skins and morph targets of their files. Objects
/// with one file for each frame have no counterpart, for which `warnings` gets a line. Empty if
/// nothing moves. Throws as GltfSource.
ObjectMotions object_motions(const SceneDesc& now, const SceneDesc& then, const SurfaceNames& names,
                             std::vector<std::string>& warnings);

}  // namespace uw
