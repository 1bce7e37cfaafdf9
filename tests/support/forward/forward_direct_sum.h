#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/forward/blur_fractions.h"

namespace uw::test {

/// The change due to `light` in each pixel of an image of `width` columns in one band, summed over
/// all pairs of pixels: each spreads its own over its own `range` [m] in uniform water of
/// attenuation `c`, seen with focal length `focal` [pixels].
inline std::vector<double> direct_sum(const ForwardScatterDesc& desc, double c, double focal,
                                      int width, const std::vector<double>& light,
                                      const std::vector<double>& range) {
    std::vector<double> sum(light.size());
    const int pixels = static_cast<int>(light.size()), height = pixels / width;
    for (int i = 0; i < pixels; ++i) {
        const auto from = static_cast<std::size_t>(i);
        if (light[from] == 0) continue;
        const double r = range[from];
        const double gained = desc.K * (std::exp(-desc.G * r) - std::exp(-c * r));
        const BlurFractions fractions(desc.shape, focal * desc.B * r / (2 * std::numbers::pi), 200);
        for (int j = 0; j < pixels; ++j)
            sum[static_cast<std::size_t>(j)] +=
                light[from] * gained *
                fractions.mirrored(i % width, i / width, j % width, j / width, width, height);
    }
    return sum;
}

}  // namespace uw::test
