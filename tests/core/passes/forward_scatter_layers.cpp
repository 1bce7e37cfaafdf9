// ctest labels: unit analytic
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "core/passes/forward_scatter.h"
#include "tests/support/forward/blur_fractions.h"
#include "tests/support/forward/forward_direct_sum.h"
#include "tests/support/forward/forward_scatter_cases.h"

namespace uw {
namespace {

using Shape = ForwardScatterDesc::Shape;
using namespace test::forward_scatter;

class ForwardScatterLayers : public testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Shapes, ForwardScatterLayers,
                         testing::Values(Shape::exponential, Shape::gaussian),
                         [](const auto& instance) {
                             return instance.param == Shape::exponential ? "exponential"
                                                                         : "gaussian";
                         });

// The sum over source pixels of their own kernels, taken directly: a depth edge between a near
// slope and a far one. The ladder of widths moves 0.25 % of the light at most, which shows most in
// dark pixels beside bright ones; over the image it averages out.
TEST_P(ForwardScatterLayers, DepthEdgeIsTheDirectSum) {
    const ForwardScatterDesc desc = with_shape(GetParam());
    const ScatterPlane plane{48, 48, k_focal, k_focal};
    const Image light = random_image(pixels(plane), 0, 10, 1);
    Image range(pixels(plane));
    std::vector<double> truth(pixels(plane));
    for (int x0 = 0; x0 < 48; ++x0) {
        const float metres =
            x0 < 24 ? 0.5F + 0.03F * static_cast<float>(x0) : 3.0F + 0.1F * static_cast<float>(x0);
        const double s = width_per_metre(desc) * static_cast<double>(metres);
        const test::BlurFractions fractions(GetParam(), s, 300);
        for (int y0 = 0; y0 < 48; ++y0) {
            const auto from = static_cast<std::size_t>(y0 * 48 + x0);
            range[from] = metres;
            const double given =
                energy(desc, static_cast<double>(metres)) * static_cast<double>(light[from]);
            for (int y = 0; y < 48; ++y)
                for (int x = 0; x < 48; ++x)
                    truth[static_cast<std::size_t>(y * 48 + x)] +=
                        given * fractions.mirrored(x0, y0, x, y, 48, 48);
        }
    }
    const Image added = scattered(desc, plane, light, range);
    double squares = 0, difference = 0, worst = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double off = static_cast<double>(added[i]) - truth[i];
        squares += truth[i] * truth[i];
        difference += off * off;
        worst = std::max(worst, std::abs(off) / truth[i]);
    }
    EXPECT_LT(std::sqrt(difference / squares), 1e-3);
    EXPECT_LT(worst, 5e-3);
}

// Between the widths of the ladder, which two faint lights span here, a kernel is a mixture: the
// fraction of light that lands elsewhere than it should.
TEST_P(ForwardScatterLayers, LadderOfWidthsMovesLittleLight) {
    const ForwardScatterDesc desc = with_shape(GetParam());
    const ScatterPlane plane{65, 65, k_focal, k_focal};
    double worst = 0;
    for (double metres = 0.05; metres < 15; metres *= 1.13) {
        Image light(pixels(plane)), range(pixels(plane), static_cast<float>(metres));
        light[0] = light[1] = 1e-12F;
        range[0] = 0;
        range[1] = 20;
        light[32 * 65 + 32] = 1;
        const Image added = scattered(desc, plane, light, range);
        const double s = width_per_metre(desc) * static_cast<double>(range[2]);
        const test::BlurFractions fractions(GetParam(), s, 200);
        double moved = 0;
        for (int y = 0; y < 65; ++y)
            for (int x = 0; x < 65; ++x)
                moved += 0.5 *
                         std::abs(static_cast<double>(added[static_cast<std::size_t>(y * 65 + x)]) /
                                      energy(desc, static_cast<double>(range[2])) -
                                  fractions.mirrored(32, 32, x, y, 65, 65));
        worst = std::max(worst, moved);
    }
    EXPECT_LT(worst, 2.5e-3);
    EXPECT_GT(worst, 1e-3);  // the ranges did fall between
}

// Kernels wide enough for coarse grids, on both sides of a step in depth, up to the borders, on
// images whose sides have no small factors. Of the image's mean: 0.2 % RMS, and 1 % at any pixel of
// at least that, is what forward scatter may be off; here single bright pixels stand in the dark,
// more of it in high frequencies than any picture.
TEST_P(ForwardScatterLayers, WideKernelsAreTheDirectSum) {
    for (const auto& [width, height, focal] : {std::tuple{67, 41, 1500.0}, {73, 53, 3000.0}}) {
        const ForwardScatterDesc desc = with_shape(GetParam());
        Image light = random_image(static_cast<std::size_t>(width * height), 0, 10, 21);
        for (std::size_t i = 0; i < light.size(); ++i)
            if (i % 7 != 0) light[i] = 0;
        Image range;
        for (int i = 0; i < width * height; ++i)
            range.push_back(i % width < width / 2 ? 1.0F + 0.01F * static_cast<float>(i % width)
                                                  : 2.5F + 0.02F * static_cast<float>(i / width));
        const std::vector<double> truth = test::direct_sum(
            desc, k_c, focal, width, {light.begin(), light.end()}, {range.begin(), range.end()});
        Image added(light.size());
        ForwardScatter scatter(desc, {width, height, focal, focal});
        scatter.add({light, range, {}, k_c});
        scatter.finish(added);
        double mean = 0, squares = 0, worst = 0;
        for (const double value : truth) mean += value / static_cast<double>(truth.size());
        for (std::size_t i = 0; i < truth.size(); ++i) {
            const double off = static_cast<double>(added[i]) - truth[i];
            squares += off * off / static_cast<double>(truth.size());
            worst = std::max(worst, std::abs(off) / std::max(mean, truth[i]));
        }
        EXPECT_LT(std::sqrt(squares), 2e-3 * mean) << width;
        EXPECT_LT(worst, 1e-2) << width;
    }
}

}  // namespace
}  // namespace uw
