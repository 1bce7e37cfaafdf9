// ctest labels: unit analytic
#include "core/paths/point_spread.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace uw::test {
namespace {

// The transfer function 1 / (1 + k / k_knee), which falls over many octaves, as that of water does.
constexpr double k_knee = 20, k_pixel = 0.005;

double transfer_at(double k) {
    return 1 / (1 + k / k_knee);
}

// The brightness of a step at a distance from its edge [pixels], averaged over the surface's pixels
// and the image's: 1/2 + 1/pi int_0^inf H(k) sin(k x) / k sinc(k / 2)^2 dk, by the midpoint rule.
double step_at(double x) {
    double sum = 0.5;
    constexpr double k_least = 1e-4, k_most = 1e4, k_growth = 1.0005;
    for (double k = k_least; k < k_most; k *= k_growth) {
        const double middle = k * std::sqrt(k_growth);
        const double sinc = std::sin(0.5 * middle) / (0.5 * middle);
        sum += transfer_at(middle / k_pixel) * std::sin(middle * x) * sinc * sinc *
               std::log(k_growth) / std::numbers::pi;
    }
    return sum;
}

TEST(BlurFit, BlursAnEdgeAsTheTransferFunctionDoes) {
    constexpr int k_size = 2048;
    PointSpread::Transfer transfer;
    for (std::size_t i = 0; i < transfer.size(); ++i)
        transfer[i] = static_cast<float>(transfer_at(PointSpread::frequency(i)));
    const int levels = BlurPyramid::level_count(k_size, 1);
    const BlurFit fit(levels, k_pixel);
    std::vector<double> weights(static_cast<std::size_t>(levels));
    fit.fit(transfer, weights);
    // The edge has several positions relative to the pixels of the coarser levels.
    for (const int edge : {1024, 1025, 1027, 1030}) {
        BlurPyramid pyramid;
        pyramid.begin(k_size, 1);
        for (int level = 0; level < levels; ++level) {
            Grid2D<float> image(k_size, 1, 0.0F);
            for (int i = edge; i < k_size; ++i)
                image(i, 0) = static_cast<float>(weights[static_cast<std::size_t>(level)]);
            pyramid.add(level, image);
        }
        const Grid2D<float>& blurred = pyramid.sum();
        for (const int i : {-40, -12, -5, -2, -1, 0, 1, 4, 11, 39})
            // The tolerance is a fraction of the step, as coarse pixels alias frequencies beyond
            // theirs.
            EXPECT_NEAR(blurred(edge + i, 0), step_at(i + 0.5), 0.01) << edge << " " << i;
        // The slope from pixel to pixel, which is steepest at the edge: by a tenth more where the
        // edge is one of all coarser pixels.
        EXPECT_NEAR(blurred(edge, 0) - blurred(edge - 1, 0), 2 * step_at(0.5) - 1,
                    0.12 * (2 * step_at(0.5) - 1))
            << edge;
    }
}

TEST(BlurFit, UsesTheLastFrequencyBeyondTheTable) {
    const double last = PointSpread::frequency(PointSpread::k_frequencies - 1);
    for (const double pixel : {2.5 / last, 1 / last, 0.3 / last}) {
        constexpr int k_levels = 3;
        constexpr float k_fraction = 0.7F;
        PointSpread::Transfer transfer;
        transfer.fill(k_fraction);
        std::array<double, k_levels> weights{};
        BlurFit(k_levels, pixel).fit(transfer, weights);
        // A uniform surface has this fraction of its light in the blur.
        EXPECT_NEAR(weights[0] + weights[1] + weights[2], 0.7, 0.01) << pixel * last;
    }
}

}  // namespace
}  // namespace uw::test
