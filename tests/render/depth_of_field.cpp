// ctest labels: analytic metamorphic
// Depth of field: the aperture sampled by the rays of a pixel (docs/camera-image.md).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/image_laws.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr double k_fast_focal_length = 0.05, k_fast_f_number = 1.4,
                 k_radius = k_fast_focal_length / 2 / k_fast_f_number;

Film backscatter_of(const SceneDesc& desc) {
    return image_of(desc, {.layers = "backscatter"});
}

SceneDesc focused_scene(int side) {
    SceneDesc desc = pinhole_scene(side, side);
    desc.water.absorption = PerBand{0, 0, 0};
    desc.water.scattering->b = {0, 0, 0};
    desc.lamps = {isotropic_lamp({0, 0, 0}, 40)};
    return desc;
}

struct BlurSpot {
    double sum = 0, variance_x = 0, variance_y = 0;  // [pixels^2]
};
BlurSpot blur_spot_of(const Film& film) {
    BlurSpot spot;
    double x1 = 0, y1 = 0, x2 = 0, y2 = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const double value = static_cast<double>(film.pixel(x, y)[0]);
            spot.sum += value;
            x1 += value * x;
            y1 += value * y;
            x2 += value * x * x;
            y2 += value * y * y;
        }
    spot.variance_x = x2 / spot.sum - std::pow(x1 / spot.sum, 2);
    spot.variance_y = y2 / spot.sum - std::pow(y1 / spot.sum, 2);
    return spot;
}

/// A bright thing is blurred by an evenly lit disk of radius fx a |1/z_f - 1/z|, whose variance
/// along each axis is a quarter of that squared, and no light is lost.
TEST(DepthOfField, ABrightThingIsBlurredByTheCircleOfConfusion) {
    for (const double depth : {2.0, 0.7, 1.0}) {
        SceneDesc desc = focused_scene(64);
        desc.camera.intrinsics = {600, 600, 32, 32};
        const double half = 0.01 * depth;  // 6 pixels
        desc.geometry = {box({-half, -half, depth}, {half, half, depth + 0.01})};
        desc.render.samples = 1024;
        const BlurSpot sharp = blur_spot_of(backscatter_of(desc));
        desc.camera.lens = LensDesc{k_fast_f_number, k_fast_focal_length, 1, 1.0};
        const BlurSpot blurred = blur_spot_of(backscatter_of(desc));
        const double circle = 600 * k_radius * std::abs(1 - 1 / depth);
        // The lamp is at the pinhole; from elsewhere on the lens the box looks as bright, as it is
        // diffuse. 1024 samples in each of 144 pixels: their variance is known to 0.26 %, which is
        // a quarter of this.
        EXPECT_NEAR(blurred.sum / sharp.sum, 1, 0.01) << depth;
        EXPECT_NEAR(blurred.variance_x - sharp.variance_x, circle * circle / 4,
                    0.01 * blurred.variance_x)
            << depth;
        EXPECT_NEAR(blurred.variance_y - sharp.variance_y, circle * circle / 4,
                    0.01 * blurred.variance_y)
            << depth;
    }
}

/// The slow truth: the mean over pinholes all over the lens, each turned to the plane in focus.
TEST(DepthOfField, IsTheMeanOverPinholesAllOverTheLens) {
    SceneDesc desc = pinhole_scene(32, 24);
    desc.geometry = {plane_at_z(3), box({-0.3, -0.2, 0.5}, {-0.05, 0.25, 0.7}),
                     box({0.1, -0.3, 1.4}, {0.6, 0.2, 1.6})};
    desc.geometry[1].reflectance = {PerBand{0.9, 0.6, 0.2}};
    desc.lamps = {isotropic_lamp({0.4, -0.5, 0}, 40)};
    desc.lamps[0].fixed_to_camera = false;
    constexpr double k_focus = 1.5;
    std::vector<double> truth(32 * 24 * 3), water(32 * 24 * 3);
    constexpr int k_rings = 8;
    int count = 0;
    Renderer renderer;  // one, which keeps what does not move: the light of the lamp
    for (int i = 0; i < k_rings; ++i) {
        const int around = 6 * i + 3;  // equal areas, nearly
        for (int j = 0; j < around; ++j, ++count) {
            // Ring i holds (2 i + 1) of k_rings^2 parts, as `around` does.
            const double radius = k_radius * (i + 0.5) / k_rings;
            const double angle = 2 * std::numbers::pi * (j + 0.37 * i) / around;
            const double u = radius * std::cos(angle), v = radius * std::sin(angle);
            SceneDesc displaced = desc;
            displaced.render.samples = 16;
            displaced.camera.world_from_camera = Affine::translation({u, v, 0});
            displaced.camera.intrinsics.cx += displaced.camera.intrinsics.fx * u / k_focus;
            displaced.camera.intrinsics.cy += displaced.camera.intrinsics.fy * v / k_focus;
            renderer.set_scene(std::move(displaced));
            const Film& film = renderer.render({.layers = "backscatter"});
            std::size_t k = 0;
            for (int y = 0; y < 24; ++y)
                for (int x = 0; x < 32; ++x)
                    for (std::size_t c = 0; c < 3; ++c, ++k) {
                        truth[k] += static_cast<double>(film.pixel(x, y)[c]);
                        water[k] += static_cast<double>(film.pixel(x, y)[4 + c]);
                    }
        }
    }
    desc.camera.lens = LensDesc{k_fast_f_number, k_fast_focal_length, 1, k_focus};
    desc.render.samples = 1024;
    const Film film = backscatter_of(desc);
    double squares = 0, water_squares = 0, mean = 0, water_mean = 0, blur = 0;
    desc.camera.lens.reset();
    const Film sharp = backscatter_of(desc);
    std::size_t k = 0;
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x)
            for (std::size_t c = 0; c < 3; ++c, ++k) {
                const double expected = truth[k] / count, in_water = water[k] / count;
                squares += std::pow(static_cast<double>(film.pixel(x, y)[c]) - expected, 2);
                blur += std::pow(static_cast<double>(sharp.pixel(x, y)[c]) - expected, 2);
                water_squares +=
                    std::pow(static_cast<double>(film.pixel(x, y)[4 + c]) - in_water, 2);
                mean += expected;
                water_mean += in_water;
            }
    const auto n = static_cast<double>(truth.size());
    // RMS over the mean. The pinholes are 192 points of the disk, the lens's samples 1024, of which
    // an edge in a pixel sees some tens: 1 %. The water's light is that along the ray through the
    // lens's centre, which the truth displaces by up to 18 mm.
    EXPECT_LT(std::sqrt(squares / n) / (mean / n), 0.01);
    EXPECT_LT(std::sqrt(water_squares / n) / (water_mean / n), 0.01);
    // And it is no small effect.
    EXPECT_GT(std::sqrt(blur / n) / (mean / n), 0.05);
}

TEST(DepthOfField, IsTheSameForThreadsAndCropsAndLeavesGroundTruthSharp) {
    SceneDesc desc = pinhole_scene(40, 36);
    desc.geometry = {plane_at_z(3), box({-0.3, -0.2, 0.5}, {-0.05, 0.25, 0.7})};
    desc.lamps = {isotropic_lamp({0.4, -0.5, 0}, 40)};
    desc.render.samples = 8;
    const Film sharp = image_of(desc, {.layers = "depth"});
    desc.camera.lens = LensDesc{k_fast_f_number, k_fast_focal_length, 1, 3.0};
    const Film whole =
        expect_same_for_threads_and_windows(desc, {.layers = "depth"}, {5, 3, 37, 34});
    int differ = 0;
    for (int y = 0; y < whole.height(); ++y)
        for (int x = 0; x < whole.width(); ++x) {
            EXPECT_EQ(whole.pixel(x, y)[4], sharp.pixel(x, y)[4]);
            differ += whole.pixel(x, y)[0] != sharp.pixel(x, y)[0] ? 1 : 0;
        }
    EXPECT_GT(differ, 100);
}

/// Light paths see through the same lens.
TEST(DepthOfField, OfLightPathsIsThatOfTheOtherIntegrators) {
    SceneDesc desc = pinhole_scene(16, 12);
    desc.geometry = {plane_at_z(3), box({-0.3, -0.2, 0.5}, {-0.05, 0.25, 0.7})};
    desc.lamps = {isotropic_lamp({0.4, -0.5, 0}, 40)};
    desc.camera.lens = LensDesc{k_fast_f_number, k_fast_focal_length, 1, 3.0};
    desc.render.samples = 1024;
    const Film volume = image_of(desc, {.layers = "direct"});
    desc.render.integrator = RenderDesc::Integrator::path;
    const Film paths = image_of(desc, {.layers = "direct"});
    double squares = 0, mean = 0;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 16; ++x) {
            const double a = static_cast<double>(volume.pixel(x, y)[4]);
            squares += std::pow(static_cast<double>(paths.pixel(x, y)[4]) - a, 2);
            mean += a;
        }
    // 1024 random points of the lens: a pixel half covered by the box has an error of 1.6 % of the
    // difference between box and wall.
    EXPECT_LT(std::sqrt(squares / (16 * 12)) / (mean / (16 * 12)), 0.02);
}

}  // namespace
}  // namespace uw::test
