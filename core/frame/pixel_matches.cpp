#include "core/frame/pixel_matches.h"

#include <vector>

namespace uw {

void find_matches(const PointMatchers& matchers, std::span<PixelView> views) {
    if (!matchers.next && !matchers.previous && !matchers.other_camera) return;
    thread_local std::vector<const SurfaceHit*> hits;
    thread_local std::vector<std::optional<PointMatch>> matches;
    hits.clear();
    for (const PixelView& view : views)
        if (view.has_hit) hits.push_back(&view.hit);
    matches.resize(hits.size());
    const auto look = [&](const PointMatcher* matcher,
                          std::optional<PointMatch> PointMatches::*which) {
        if (!matcher) return;
        matcher->match(hits, matches);
        auto match = matches.begin();
        for (PixelView& view : views)
            if (view.has_hit) view.matches.*which = *match++;
    };
    look(matchers.next, &PointMatches::next);
    look(matchers.previous, &PointMatches::previous);
    look(matchers.other_camera, &PointMatches::other_camera);
}

void store_matches(const PointMatchers& matchers, const PixelView& view, PixelResult& result) {
    const auto store = [&](const PointMatcher* matcher, const std::optional<PointMatch>& match,
                           double sign, std::array<double, 2>& offset, double* occluded) {
        if (!matcher || !match) return;
        offset = {sign * (match->x - view.x), sign * (match->y - view.y)};
        if (occluded) *occluded = match->is_occluded ? 1 : 0;
    };
    store(matchers.next, view.matches.next, 1, result.flow, &result.flow_occluded);
    store(matchers.previous, view.matches.previous, 1, result.flow_back, nullptr);
    store(matchers.other_camera, view.matches.other_camera, matchers.is_first_camera ? -1 : 1,
          result.disparity, &result.disparity_occluded);
}

}  // namespace uw
