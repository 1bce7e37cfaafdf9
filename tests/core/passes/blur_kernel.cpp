// ctest labels: unit analytic
#include "core/passes/mirrored_blur.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/forward/blur_fractions.h"

namespace uw {
namespace {

using Shape = ForwardScatterDesc::Shape;

// The image of one pixel of light 1 at (x0, y0).
std::vector<double> blurred_point(Shape shape, BlurWidth blur, int width, int height, int x0,
                                  int y0) {
    MirroredBlur sum(width, height);
    sum.add(
        [&](int y, std::span<double> row) {
            if (y == y0) row[static_cast<std::size_t>(x0)] = 1;
            return y == y0;
        },
        BlurKernel(shape, blur, width, height));
    std::vector<double> image(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    sum.finish([&](int y, std::span<const double> row) {
        std::copy(row.begin(), row.end(), image.begin() + y * width);
    });
    return image;
}

class BothShapes : public testing::TestWithParam<Shape> {};

// Every pixel's fraction in closed form, from far below a pixel to wider than the image. The point
// stands off the centre so that its mirror images count. 5e-7 is what the table of aliases and the
// far mirror images, taken as even here, leave.
TEST_P(BothShapes, SharesOfAPointInEveryPixel) {
    constexpr int k_width = 61, k_height = 40, k_x = 7, k_y = 31;
    for (const double s : {1e-9, 0.003, 0.05, 0.1, 0.3, 0.7, 1.0, 1.4, 2.5, 5.0, 13.0, 30.0}) {
        const auto image = blurred_point(GetParam(), {s, s}, k_width, k_height, k_x, k_y);
        const test::BlurFractions fractions(GetParam(), s, 800);
        double sum = 0, worst = 0;
        for (int y = 0; y < k_height; ++y) {
            for (int x = 0; x < k_width; ++x) {
                const double fraction = image[static_cast<std::size_t>(y * k_width + x)];
                const double truth = fractions.mirrored(k_x, k_y, x, y, k_width, k_height);
                worst = std::max(worst, std::abs(fraction - truth));
                EXPECT_GE(fraction, -1e-8) << s;
                sum += fraction;
            }
        }
        EXPECT_LT(worst, 5e-7) << s;
        EXPECT_NEAR(sum, 1, 1e-9) << s;
    }
}

// The radial profile against the stated formulas. A pixel's fraction is the mean of the density
// over the pixel, which to leading order is the density plus its Laplacian / 24; the rest is below
// a fifth of that from two pixels on. 1e-3: mirror images in a frame this large.
TEST_P(BothShapes, RadialProfileIsTheFormula) {
    constexpr int k_side = 1024, k_center = 512;
    for (const double s : {0.3, 1.0, 5.0, 30.0}) {
        const auto image = blurred_point(GetParam(), {s, s}, k_side, k_side, k_center, k_center);
        const auto density = [&](double r) { return test::blur_density(GetParam(), s, r); };
        for (const auto& [dx, dy] : {std::pair{2, 0},
                                     {0, 2},
                                     {2, 1},
                                     {3, 0},
                                     {3, 3},
                                     {0, 5},
                                     {4, 7},
                                     {12, 0},
                                     {8, 15},
                                     {0, 25},
                                     {30, 0}}) {
            const double r = std::hypot(dx, dy), h = 1e-3 * r;
            const double slope = (density(r + h) - density(r - h)) / (2 * h);
            const double bend = (density(r + h) - 2 * density(r) + density(r - h)) / (h * h);
            const double pixel = std::abs(bend + slope / r) / 24;
            const double fraction =
                image[static_cast<std::size_t>((k_center + dy) * k_side + k_center + dx)];
            // A Gaussian narrower than a pixel is not smooth over the pixel: 2e-4 of the light.
            const double narrow = GetParam() == Shape::gaussian && s < 0.5 ? 2e-4 : 0;
            EXPECT_NEAR(fraction, density(r), 1.2 * pixel + 1e-3 * density(r) + 1e-9 + narrow)
                << "s " << s << " at " << dx << ", " << dy;
        }
    }
}

TEST_P(BothShapes, PixelsThatAreNotSquare) {
    constexpr int k_width = 31, k_height = 50, k_x = 15, k_y = 24;
    const auto image = blurred_point(GetParam(), {0.4, 1.2}, k_width, k_height, k_x, k_y);
    // Three narrow pixels side by side are one square one: the same light in the same square.
    const auto square =
        blurred_point(GetParam(), {1.2, 1.2}, 3 * k_width, k_height, 3 * k_x + 1, k_y);
    for (int y = 0; y < k_height; ++y) {
        for (int x = 0; x < k_width; ++x) {
            const auto wide = static_cast<std::size_t>((y * k_width + x) * 3);
            EXPECT_NEAR(image[static_cast<std::size_t>(y * k_width + x)],
                        square[wide] + square[wide + 1] + square[wide + 2], 1e-7);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, BothShapes, testing::Values(Shape::exponential, Shape::gaussian),
                         [](const auto& instance) {
                             return instance.param == Shape::exponential ? "exponential"
                                                                         : "gaussian";
                         });

}  // namespace
}  // namespace uw
