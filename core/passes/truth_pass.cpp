#include "core/passes/truth_pass.h"

#include "core/base/parallel.h"

namespace uw {

void TruthPass::provide(LayerSupply& supply) const {
    if (subjects_.frames) supply.layers |= {Layer::flow, Layer::flow_back, Layer::flow_occluded};
    if (subjects_.cameras) supply.layers |= {Layer::disparity, Layer::disparity_occluded};
    if (subjects_.plume)
        supply.layers |= {Layer::plume_optical_depth, Layer::plume_opacity, Layer::plume_range_50,
                          Layer::plume_range_10};
    if (subjects_.frames && subjects_.moving_plume) supply.layers |= {Layer::plume_flow};
}

void TruthPass::run(Rendering& rendering) {
    const PixelWindow& window = rendering.film.window();
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        PixelResult result;
        const int y = window.y0 + static_cast<int>(line);
        if (rendering.has_truth && !rendering.has_truth(y)) return;
        for (int x = window.x0; x < window.x1; ++x) {
            rendering.pixels.find_truth(x, y, result);
            store_truth(result, rendering.plan, rendering.film.pixel(x, y));
        }
    });
}

}  // namespace uw
