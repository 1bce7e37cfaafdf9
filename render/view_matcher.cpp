#include "render/view_matcher.h"

#include <utility>

namespace uw {

ViewMatcher::ViewMatcher(Camera camera, ObjectMotions motions,
                         std::shared_ptr<const Surfaces> surfaces)
    : camera_(std::move(camera)), motions_(std::move(motions)), surfaces_(std::move(surfaces)) {}

std::optional<Point3> ViewMatcher::moved(const SurfaceHit& hit) const {
    if (motions_.empty()) return hit.position;
    const std::optional<Affine>& motion = motions_.at(hit.object_id - 1);
    return motion ? std::optional(*motion * hit.position) : std::nullopt;
}

void ViewMatcher::match(std::span<const SurfaceHit* const> hits,
                        std::span<std::optional<PointMatch>> matches) const {
    thread_local std::vector<Point3> from, to;
    thread_local std::vector<PointMatch*> within;
    thread_local std::vector<char> blocked;
    from.clear();
    to.clear();
    within.clear();
    for (std::size_t i = 0; i < hits.size(); ++i) {
        matches[i].reset();
        const std::optional<Point3> point = moved(*hits[i]);
        if (!point) continue;
        PointMatch& match = matches[i].emplace();
        const std::optional<Sighting> seen = camera_.sight(*point);
        if (!seen) continue;
        match.x = seen->image.x;
        match.y = seen->image.y;
        const bool is_outside =
            match.x < 0 || match.y < 0 || match.x >= camera_.width() || match.y >= camera_.height();
        if (!surfaces_ || is_outside) continue;
        from.push_back(seen->ray.origin);
        to.push_back(*point);
        within.push_back(&match);
    }
    if (!surfaces_) return;
    blocked.resize(within.size());
    surfaces_->occluded_many(from, to, blocked);
    for (std::size_t i = 0; i < within.size(); ++i) within[i]->is_occluded = blocked[i] != 0;
}

}  // namespace uw
