// ctest labels: unit analytic
#include "core/paths/point_spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace uw::test {
namespace {

TEST(BlurPyramid, LeavesEvenImagesEven) {
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 3}, {37, 21}, {64, 64}}) {
        BlurPyramid pyramid;
        pyramid.begin(width, height);
        const int levels = BlurPyramid::level_count(width, height);
        for (int level = 0; level < levels; ++level) {
            Grid2D<float> image(width, height, 1.5F);
            pyramid.add(level, image);
        }
        // The tolerance is the rounding to float.
        const double sum = 1.5 * levels;
        for (const float value : pyramid.sum())
            EXPECT_NEAR(static_cast<double>(value), sum, 1e-5 * sum);
    }
}

// A point of light far from the edges keeps its light and its centre, and gets the variance of the
// level, wherever it lies relative to the pixels of the coarser levels.
TEST(BlurPyramid, BlursByTheWidthOfItsLevel) {
    constexpr int k_size = 192;
    for (int level = 0; level <= 4; ++level) {
        for (const int x : {96, 97, 103}) {
            const int y = x + 2;
            BlurPyramid pyramid;
            pyramid.begin(k_size, k_size);
            Grid2D<float> image(k_size, k_size, 0.0F);
            image(x, y) = 1;
            pyramid.add(level, image);
            const Grid2D<float>& blurred = pyramid.sum();
            double sum = 0, mean = 0, square = 0;
            for (int j = 0; j < k_size; ++j) {
                for (int i = 0; i < k_size; ++i) {
                    const auto value = static_cast<double>(blurred(i, j));
                    sum += value;
                    mean += value * (i - x);
                    square += value * (i - x) * (i - x);
                }
            }
            EXPECT_NEAR(sum, 1, 1e-5);
            // The kernel is symmetric about the middle of the coarse pixels' corners, which are
            // linear B-splines at every step, so that the centre is kept exactly.
            EXPECT_NEAR(mean, 0, 1e-4);
            const double variance = BlurPyramid::deviation(level) * BlurPyramid::deviation(level);
            EXPECT_NEAR(square, variance, 1e-4 * std::max(variance, 1.0)) << level << " " << x;
        }
    }
}

// The transfer of a wave is averaged over its positions relative to the pixels of the coarser
// levels.
TEST(BlurPyramid, HasTheTransferFunctionOfItsLevel) {
    constexpr int k_size = 256;
    for (int level = 0; level <= 4; ++level) {
        for (const int waves : {3, 9, 21, 50, 100}) {
            const double omega = 2 * std::numbers::pi * waves / k_size;
            BlurPyramid pyramid;
            pyramid.begin(k_size, 1);
            Grid2D<float> image(k_size, 1);
            for (int i = 0; i < k_size; ++i) image(i, 0) = static_cast<float>(std::cos(omega * i));
            pyramid.add(level, image);
            const Grid2D<float>& blurred = pyramid.sum();
            double sum = 0;
            for (int i = 64; i < 192; ++i) sum += 2 * blurred(i, 0) * std::cos(omega * i) / 128;
            // The part that is evaluated does not contain a whole number of waves.
            EXPECT_NEAR(sum, BlurPyramid::transfer(level, omega), 0.03) << level << " " << waves;
        }
    }
}

TEST(BlurPyramid, AddsUpItsLevels) {
    BlurPyramid pyramid;
    Grid2D<float> both(40, 30, 0.0F);
    for (const int level : {1, 3}) {
        pyramid.begin(40, 30);
        Grid2D<float> image(40, 30, 0.0F);
        image(20, 11) = static_cast<float>(level);
        pyramid.add(level, image);
        const Grid2D<float>& one = pyramid.sum();
        for (std::size_t i = 0; i < both.size(); ++i) both[i] += one[i];
    }
    pyramid.begin(40, 30);
    for (const int level : {3, 1}) {
        Grid2D<float> image(40, 30, 0.0F);
        image(20, 11) = static_cast<float>(level);
        pyramid.add(level, image);
    }
    const Grid2D<float>& sum = pyramid.sum();
    for (std::size_t i = 0; i < both.size(); ++i) EXPECT_NEAR(sum[i], both[i], 1e-6);
}

}  // namespace
}  // namespace uw::test
