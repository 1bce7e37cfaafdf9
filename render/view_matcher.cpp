#include "render/view_matcher.h"

#include <utility>

namespace uw {

ViewMatcher::ViewMatcher(Camera camera, ObjectMotions motions,
                         std::shared_ptr<const Surfaces> surfaces)
    : camera_(std::move(camera)), motions_(std::move(motions)), surfaces_(std::move(surfaces)) {}

std::optional<PointMatch> ViewMatcher::match(const SurfaceHit& hit) const {
    Point3 point = hit.position;
    if (!motions_.empty()) {
        const std::optional<Affine>& motion = motions_.at(hit.object_id - 1);
        if (!motion) return std::nullopt;
        point = *motion * point;
    }
    const std::optional<ImagePoint> seen = camera_.project(point);
    if (!seen) return PointMatch{};
    PointMatch match{seen->x, seen->y, false};
    if (!surfaces_) return match;
    match.is_occluded =
        seen->x < 0 || seen->y < 0 || seen->x >= camera_.width() || seen->y >= camera_.height();
    if (match.is_occluded) return match;
    const std::optional<Ray> ray = camera_.refracted_ray(seen->x, seen->y);
    match.is_occluded = !ray || surfaces_->occluded(ray->origin, point);
    return match;
}

}  // namespace uw
