#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "camera/camera.h"
#include "core/frame/point_matcher.h"

namespace uw {

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

}  // namespace uw
