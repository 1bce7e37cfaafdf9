// ctest labels: unit analytic metamorphic
#include "core/passes/forward_scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "tests/support/forward/blur_fractions.h"
#include "tests/support/forward/forward_scatter_cases.h"

namespace uw {
namespace {

using Shape = ForwardScatterDesc::Shape;
using namespace test::forward_scatter;

class ForwardScatterShapes : public testing::TestWithParam<Shape> {};

INSTANTIATE_TEST_SUITE_P(Shapes, ForwardScatterShapes,
                         testing::Values(Shape::exponential, Shape::gaussian),
                         [](const auto& instance) {
                             return instance.param == Shape::exponential ? "exponential"
                                                                         : "gaussian";
                         });

TEST_P(ForwardScatterShapes, EnergyIsTheSourcesTimesTheirFactors) {
    const ScatterPlane plane{97, 60, k_focal, k_focal};
    for (const double g : {-0.4, 0.0, 0.1, 0.4}) {
        ForwardScatterDesc desc = with_shape(GetParam());
        desc.G = g;
        const Image light = random_image(pixels(plane), 0, 1e4, 2);
        const Image range = random_image(pixels(plane), 0, 60, 3);
        double truth = 0;
        for (std::size_t i = 0; i < light.size(); ++i)
            truth += static_cast<double>(light[i]) * energy(desc, static_cast<double>(range[i]));
        // 1e-6: pixels are floats.
        EXPECT_NEAR(sum(scattered(desc, plane, light, range)), truth, 1e-6 * truth) << g;
    }
}

TEST_P(ForwardScatterShapes, SingleRangeIsExactAndASlabIsAnImageOfOneRange) {
    const ForwardScatterDesc desc = with_shape(GetParam());
    const ScatterPlane plane{61, 41, k_focal, k_focal};
    Image light(pixels(plane));
    light[20 * 61 + 30] = 2;
    const Image range(pixels(plane), 2.5F);
    const Image added = scattered(desc, plane, light, range);
    const test::BlurFractions fractions(GetParam(), 2.5 * width_per_metre(desc), 600);
    for (int y = 0; y < 41; ++y)
        for (int x = 0; x < 61; ++x)
            EXPECT_NEAR(static_cast<double>(added[static_cast<std::size_t>(y * 61 + x)]),
                        2 * energy(desc, 2.5) * fractions.mirrored(30, 20, x, y, 61, 41), 2e-7);
    ForwardScatter scatter(desc, plane);
    scatter.add(light, 2.5, k_c);
    Image slab(pixels(plane));
    scatter.finish(slab);
    EXPECT_EQ(slab, added);
}

// The wall reflects: no dark frame, whatever the width.
TEST_P(ForwardScatterShapes, ConstantImageStaysConstant) {
    const ScatterPlane plane{64, 35, k_focal, k_focal};
    for (const float metres : {0.01F, 0.5F, 7.0F, 300.0F, 1e6F}) {
        const Image light(pixels(plane), 3.0F);
        const Image range(pixels(plane), metres);
        const double expected = 3 * energy(with_shape(GetParam()), static_cast<double>(metres));
        for (const float value : scattered(with_shape(GetParam()), plane, light, range))
            EXPECT_NEAR(static_cast<double>(value), expected, 1e-6 * expected) << metres;
    }
}

TEST_P(ForwardScatterShapes, IsLinearAndSumsWhatIsAdded) {
    const ForwardScatterDesc desc = with_shape(GetParam());
    const ScatterPlane plane{50, 33, k_focal, k_focal};
    const Image range = random_image(pixels(plane), 0.2, 9, 4);
    const Image first = random_image(pixels(plane), 0, 5, 5);
    const Image second = random_image(pixels(plane), 0, 5, 6);
    Image both(first), doubled(first);
    for (std::size_t i = 0; i < both.size(); ++i) both[i] += second[i];
    for (float& value : doubled) value *= 2;

    const Image of_first = scattered(desc, plane, first, range);
    const Image of_second = scattered(desc, plane, second, range);
    const Image of_both = scattered(desc, plane, both, range);
    const Image of_doubled = scattered(desc, plane, doubled, range);
    ForwardScatter scatter(desc, plane);
    scatter.add({first, range, {}, k_c});
    scatter.add({second, range, {}, k_c});
    Image one_after_the_other(pixels(plane));
    scatter.finish(one_after_the_other);
    for (std::size_t i = 0; i < both.size(); ++i) {
        EXPECT_EQ(of_doubled[i], 2 * of_first[i]);
        EXPECT_NEAR(of_both[i], of_first[i] + of_second[i], 1e-6F * of_both[i]);
        EXPECT_NEAR(one_after_the_other[i], of_both[i], 1e-6F * of_both[i]);
    }
    // Nothing is left behind.
    scatter.finish(one_after_the_other);
    EXPECT_EQ(one_after_the_other, Image(pixels(plane)));
}

// Energy by optical depth, width by the blur length: K [e^{-(G/c_0) tau} - e^{-tau}].
TEST(ForwardScatter, WaterThatVaries) {
    const ScatterPlane plane{41, 41, k_focal, k_focal};
    Image light(pixels(plane));
    light[20 * 41 + 20] = 1;
    const Image length(pixels(plane), 3.0F), depth(pixels(plane), 2.0F);
    ForwardScatter scatter(k_desc, plane);
    scatter.add({light, length, depth, k_c});
    Image added(pixels(plane));
    scatter.finish(added);
    const double factor = k_desc.K * (std::exp(-k_desc.G / k_c * 2.0) - std::exp(-2.0));
    EXPECT_NEAR(sum(added), factor, 1e-6);
    const test::BlurFractions fractions(Shape::exponential, 3 * width_per_metre(k_desc), 600);
    EXPECT_NEAR(added[20 * 41 + 22], factor * fractions.mirrored(20, 20, 22, 20, 41, 41), 1e-7);
    // In uniform water the two forms are one.
    Image tau(pixels(plane), static_cast<float>(3 * k_c));
    scatter.add({light, length, tau, k_c});
    scatter.finish(added);
    const Image uniform = scattered(k_desc, plane, light, length);
    for (std::size_t i = 0; i < added.size(); ++i) EXPECT_NEAR(added[i], uniform[i], 1e-7F);
}

TEST(ForwardScatter, OffIsExactlyNothing) {
    ForwardScatterDesc off = k_desc;
    off.K = 0;
    off.G = 9;  // unused, and so not refused
    const ScatterPlane plane{20, 10, k_focal, k_focal};
    const Image light = random_image(pixels(plane), 0, 5, 7);
    const Image range = random_image(pixels(plane), 0, 5, 8);
    EXPECT_EQ(scattered(off, plane, light, range), Image(pixels(plane)));
}

TEST(ForwardScatter, NoBlurLeavesTheLightWhereItIs) {
    ForwardScatterDesc sharp = k_desc;
    sharp.B = 0;
    const ScatterPlane plane{20, 10, k_focal, k_focal};
    const Image light = random_image(pixels(plane), 0, 5, 7);
    const Image range = random_image(pixels(plane), 0, 5, 8);
    const Image added = scattered(sharp, plane, light, range);
    for (std::size_t i = 0; i < light.size(); ++i)
        EXPECT_NEAR(static_cast<double>(added[i]),
                    static_cast<double>(light[i]) * energy(sharp, static_cast<double>(range[i])),
                    1e-6);
}

// Without a ray or a surface there is no path, and the film holds anything.
TEST(ForwardScatter, DarkPixelsAreNotLookedAt) {
    const ScatterPlane plane{30, 20, k_focal, k_focal};
    Image light(pixels(plane)), range(pixels(plane), std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(scattered(k_desc, plane, light, range), Image(pixels(plane)));
    light[215] = 1;
    range[215] = 2;
    const Image alone = scattered(k_desc, plane, light, range);
    EXPECT_NEAR(sum(alone), energy(k_desc, 2), 1e-6);
    EXPECT_EQ(scattered(k_desc, plane, light, Image(pixels(plane), 2.0F)), alone);
}

TEST(ForwardScatter, SameBitsForAnyNumberOfThreads) {
    const ScatterPlane plane{211, 130, k_focal, 380};
    const Image light = random_image(pixels(plane), 0, 5, 9);
    const Image range = random_image(pixels(plane), 0.3, 20, 10);
    const auto render = [&](int threads) {
        const ThreadLimit limit(threads);
        return scattered(k_desc, plane, light, range);
    };
    const Image one = render(1);
    EXPECT_EQ(render(2), one);
    EXPECT_EQ(render(5), one);
}

TEST(ForwardScatter, ImagesOfOnePixelOrOneLine) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {13, 1}}) {
        const ScatterPlane plane{width, height, k_focal, k_focal};
        const Image light = random_image(pixels(plane), 1, 2, 11);
        const Image added = scattered(k_desc, plane, light, Image(pixels(plane), 4.0F));
        EXPECT_NEAR(sum(added), sum(light) * energy(k_desc, 4), 1e-5);
    }
}

TEST(ForwardScatter, RefusesWhatIsNotPhysical) {
    const auto message = [](ForwardScatterDesc desc) -> std::string {
        try {
            check_forward_scatter(desc, std::vector{0.5, 0.3}, "scene.yaml:4:3: water");
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message({.K = 1, .G = 0.3, .B = 0}), "");
    EXPECT_EQ(message({.K = 1, .G = -0.3, .B = 0}), "");
    EXPECT_EQ(message({.K = 1, .G = 0.31, .B = 0}),
              "scene.yaml:4:3: water: G must be within -c and c in every band, found 0.31 where "
              "the water's c is 0.3 1/m; give a smaller G");
    EXPECT_NE(message({.K = 1, .G = -0.31, .B = 0}), "");
    EXPECT_NE(message({.K = -1, .G = 0, .B = 0}), "");
    EXPECT_NE(message({.K = 1, .G = 0, .B = -1}), "");
    EXPECT_NE(message({.K = 1, .G = std::nan(""), .B = 0}), "");

    const ScatterPlane plane{4, 4, k_focal, k_focal};
    const Image good(16, 1.0F);
    for (const float bad : {-1.0F, std::numeric_limits<float>::infinity(), std::nanf("")}) {
        EXPECT_THROW(scattered(k_desc, plane, Image(16, bad), good), std::invalid_argument);
        EXPECT_THROW(scattered(k_desc, plane, good, Image(16, bad)), std::invalid_argument);
    }
    EXPECT_THROW(scattered(k_desc, plane, Image(15, 1.0F), good), std::invalid_argument);
    EXPECT_THROW(scattered(k_desc, plane, good, Image(15, 1.0F)), std::invalid_argument);
}

}  // namespace
}  // namespace uw
