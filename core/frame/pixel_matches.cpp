#include "core/frame/pixel_matches.h"

namespace uw {

void find_matches(const PointMatchers& matchers, const PixelView& view, PixelResult& result) {
    const auto look = [&](const PointMatcher* matcher, double sign, std::array<double, 2>& offset,
                          double* occluded) {
        if (!matcher) return;
        const std::optional<PointMatch> match = matcher->match(view.hit);
        if (!match) return;
        offset = {sign * (match->x - view.x), sign * (match->y - view.y)};
        if (occluded) *occluded = match->is_occluded ? 1 : 0;
    };
    look(matchers.next, 1, result.flow, &result.flow_occluded);
    look(matchers.previous, 1, result.flow_back, nullptr);
    look(matchers.other_camera, matchers.is_first_camera ? -1 : 1, result.disparity,
         &result.disparity_occluded);
}

}  // namespace uw
