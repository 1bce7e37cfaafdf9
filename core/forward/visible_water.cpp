#include "core/forward/visible_water.h"

#include <algorithm>

namespace uw {

void VisibleWater::set(std::size_t pixel, const PixelView& view, const RayDepth& depth) {
    const std::size_t count = view.distances.size();
    if (count == 0 || depth.cosine() <= 0) return;
    std::size_t behind = count;  // the first distance behind the widest gap
    double widest = 1;
    for (std::size_t i = 1; i < count; ++i) {
        const double ratio = view.distances[i] / view.distances[i - 1];
        if (ratio <= widest) continue;
        widest = ratio;
        behind = i;
    }
    const auto store = [&](std::size_t part, std::size_t begin, std::size_t end) {
        double share = 0, sum = 0;
        for (std::size_t i = begin; i < end; ++i) {
            share += view.weights[i];
            sum += view.weights[i] * depth.z(view.distances[i]);
        }
        if (!(share > 0)) return;
        share_[pixel][part] = static_cast<float>(share);
        depths_[part][pixel] = static_cast<float>(sum / share);
    };
    store(0, 0, behind);
    store(1, behind, count);
}

VisibleWater::Extent VisibleWater::extent() const {
    Extent extent;
    for (std::size_t i = 0; i < size(); ++i) {
        constexpr double k_whole = 1 - 1e-6;
        if (alpha(i) < k_whole) extent.nearest = -std::numeric_limits<double>::infinity();
        for_each(i, [&](double, double end) {
            extent.nearest = std::min(extent.nearest, end);
            extent.farthest = std::max(extent.farthest, end);
        });
    }
    return extent;
}

}  // namespace uw
