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

/// How a camera sees a point of the world.
struct SeenPoint {
    static constexpr double k_none = std::numeric_limits<double>::quiet_NaN();

    ImagePoint pixel{k_none, k_none};  // NaN: no ray leads to it
    double path = k_none;              // in the water, along its ray [m]
    bool in_image = false;
    bool visible = false;  // in the image, and no surface lies before it
};

/// Whether a position lies within the camera's image, whose edges belong to it.
bool is_in_image(const ImagePoint& pixel, const Camera& camera);

/// Through lens and port (Camera::project). NaN is seen nowhere.
SeenPoint seen_point(const Point3& world, const Camera& camera, const Surfaces& surfaces);

/// How each object of a scene moves, by its id from 1: the map of its points in the world to where
/// they are at another moment; none for one whose points have no counterpart then.
using ObjectMotions = std::vector<std::optional<Affine>>;

/// Finds points in the image of another camera, at another moment, or both.
class ViewMatcher final : public PointMatcher {
  public:
    /// `motions`: of the objects that the points are of; empty: none moves. `surfaces`: at the
    /// other moment; null: whether a point is hidden is not asked.
    ViewMatcher(Camera camera, ObjectMotions motions, std::shared_ptr<const Surfaces> surfaces);

    void match(std::span<const SurfaceHit* const> hits,
               std::span<std::optional<PointMatch>> matches) const override;

  private:
    /// Where the point of a hit is at the other moment.
    std::optional<Point3> moved(const SurfaceHit& hit) const;

    Camera camera_;
    ObjectMotions motions_;
    std::shared_ptr<const Surfaces> surfaces_;
};

/// How the objects `names` of the scene `now` move until `then`, another of its frames: by their
/// trajectories and the animations of their files. Objects of files that are one for each frame
/// have no counterpart, of which `warnings` gets a line. Empty if nothing moves. Throws as
/// gltf_placements.
ObjectMotions object_motions(const SceneDesc& now, const SceneDesc& then, const SurfaceNames& names,
                             std::vector<std::string>& warnings);

}  // namespace uw
