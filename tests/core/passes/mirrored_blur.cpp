// ctest labels: unit analytic
#include "core/passes/mirrored_blur.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/parallel.h"
#include "tests/support/forward/blur_fractions.h"

namespace uw {
namespace {

using Shape = ForwardScatterDesc::Shape;

constexpr int k_blur_width = 21, k_blur_height = 13;  // no multiples of a block

/// An image of doubles, row by row.
using BlurImage = std::vector<double>;

RowSource rows_of(const BlurImage& image) {
    return [&image](int y, std::span<double> row) {
        std::copy_n(image.begin() + y * k_blur_width, k_blur_width, row.begin());
        return true;
    };
}

BlurImage take_sum(MirroredBlur& blur) {
    BlurImage sum(static_cast<std::size_t>(k_blur_width * k_blur_height));
    blur.finish([&](int y, std::span<const double> row) {
        std::copy(row.begin(), row.end(), sum.begin() + y * k_blur_width);
    });
    return sum;
}

BlurImage blurred(const BlurImage& image, Shape shape, BlurWidth width) {
    MirroredBlur blur(k_blur_width, k_blur_height);
    blur.add(rows_of(image), BlurKernel(shape, width, k_blur_width, k_blur_height));
    return take_sum(blur);
}

BlurImage varied_image() {
    BlurImage image;
    for (int i = 0; i < k_blur_width * k_blur_height; ++i)
        image.push_back(1 + std::sin(0.9 * i) + (i == 40 ? 30 : 0));
    return image;
}

void expect_same_image(const BlurImage& a, const BlurImage& b, double tolerance) {
    for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], tolerance) << "pixel " << i;
}

TEST(MirroredBlur, IsTheSumOfThePixelsFractions) {
    const BlurImage image = varied_image();
    const test::BlurFractions fractions(Shape::gaussian, 1.5, 40);
    BlurImage truth(image.size());
    for (int y = 0; y < k_blur_height; ++y)
        for (int x = 0; x < k_blur_width; ++x)
            for (int v = 0; v < k_blur_height; ++v)
                for (int u = 0; u < k_blur_width; ++u)
                    truth[static_cast<std::size_t>(y * k_blur_width + x)] +=
                        image[static_cast<std::size_t>(v * k_blur_width + u)] *
                        fractions.mirrored(u, v, x, y, k_blur_width, k_blur_height);
    expect_same_image(blurred(image, Shape::gaussian, {1.5, 1.5}), truth, 1e-9);
}

TEST(MirroredBlur, OfNoWidthLeavesTheImage) {
    const BlurImage image = varied_image();
    expect_same_image(blurred(image, Shape::gaussian, {0, 0}), image, 1e-12);
    // The mixture of Gaussians that is an exponential begins at deviates of 1e-7: what lies below,
    // sqrt(2/pi) 1e-7 of a pixel's light, is spread as if the pixel had no edges.
    constexpr double k_left_out = 8e-8, k_brightest = 32;
    expect_same_image(blurred(image, Shape::exponential, {0, 0}), image, k_left_out * k_brightest);
}

TEST(MirroredBlur, KeepsAnEvenImageAndAllLight) {
    const BlurImage even(static_cast<std::size_t>(k_blur_width * k_blur_height), 2.5);
    const BlurImage image = varied_image();
    double before = 0;
    for (const double value : image) before += value;
    for (const Shape shape : {Shape::gaussian, Shape::exponential})
        for (const BlurWidth width : {BlurWidth{0.3, 0.3}, {2, 5}, {100, 80}}) {
            expect_same_image(blurred(even, shape, width), even, 1e-11);
            double after = 0;
            for (const double value : blurred(image, shape, width)) after += value;
            EXPECT_NEAR(after, before, 1e-10 * before);
        }
}

TEST(MirroredBlur, AddsLayersEachWithItsKernel) {
    const BlurImage image = varied_image();
    BlurImage other(image.rbegin(), image.rend());
    MirroredBlur blur(k_blur_width, k_blur_height);
    blur.add(rows_of(image), BlurKernel(Shape::gaussian, {1, 2}, k_blur_width, k_blur_height));
    blur.add(rows_of(other), BlurKernel(Shape::exponential, {3, 1}, k_blur_width, k_blur_height));
    const BlurImage sum = take_sum(blur);
    const BlurImage first = blurred(image, Shape::gaussian, {1, 2});
    BlurImage expected = blurred(other, Shape::exponential, {3, 1});
    for (std::size_t i = 0; i < expected.size(); ++i) expected[i] += first[i];
    expect_same_image(sum, expected, 1e-11);
    // Handing the sum over starts anew.
    expect_same_image(take_sum(blur), BlurImage(image.size(), 0.0), 0);
}

TEST(MirroredBlur, DarkLayersAddNothing) {
    MirroredBlur blur(k_blur_width, k_blur_height);
    blur.add([](int, std::span<double>) { return false; },
             BlurKernel(Shape::gaussian, {1, 1}, k_blur_width, k_blur_height));
    const std::size_t pixels = static_cast<std::size_t>(k_blur_width * k_blur_height);
    expect_same_image(take_sum(blur), BlurImage(pixels, 0.0), 0);
}

TEST(MirroredBlur, DoesNotDependOnTheNumberOfThreads) {
    const BlurImage image = varied_image();
    const BlurImage many = blurred(image, Shape::exponential, {2, 3});
    const ThreadLimit one(1);
    EXPECT_EQ(blurred(image, Shape::exponential, {2, 3}), many);
}

}  // namespace
}  // namespace uw
