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

/// The motion of each object of a scene, by id from 1: maps its points, in world space, to those at
/// another time; none for an object whose points have no counterpart then.
using ObjectMotions = std::vector<std::optional<Affine>>;

/// Finds points in the image of another camera, at another time, or both.
class ViewMatcher final : public PointMatcher {
  public:
    /// `motions`: those of the objects to which the points belong; empty if none moves. `surfaces`:
    /// those at the other time; null if it does not matter whether a point is hidden.
    ViewMatcher(Camera camera, ObjectMotions motions, std::shared_ptr<const Surfaces> surfaces);

    void match(std::span<const SurfaceHit* const> hits,
               std::span<std::optional<PointMatch>> matches) const override;

  private:
    /// Returns the point of a hit at the other time.
    std::optional<Point3> moved(const SurfaceHit& hit) const;

    Camera camera_;
    ObjectMotions motions_;
    std::shared_ptr<const Surfaces> surfaces_;
};

/// Returns the motions of the objects `names` of the scene `now` to `then`, another of its frames,
/// by their trajectories and the animations of their files. Objects with one file for each frame
/// have no counterpart, for which `warnings` gets a line. Empty if nothing moves. Throws as
/// gltf_placements.
ObjectMotions object_motions(const SceneDesc& now, const SceneDesc& then, const SurfaceNames& names,
                             std::vector<std::string>& warnings);

}  // namespace uw
