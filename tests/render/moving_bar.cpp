// ctest labels: unit analytic slow
//
// A bar that moves while the shutter is open, against the closed form of its image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/image_scene.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/image_of.h"

namespace uw::test {
namespace {

// Frame 10 is at 1 s; the shutter is open from 0.98 s to 1.02 s.
constexpr int k_frame = 10;
constexpr double k_shutter = 0.04;

ImageScene frame_of(const std::string& text) {
    return scene_of_image(load_scene_text("uwvdb: 1\n" + text, "scene.yaml"), {k_frame});
}

/// A bar of 6 x 20 pixels at 1 m in clear water, lit evenly by a lamp far behind the camera, that
/// moves by 100 pixels per second and metre of `velocity`, through the image's centre at 1 s.
ImageScene bar_scene(double velocity, const std::string& render, const std::string& camera = "") {
    return frame_of(
        "camera: {resolution: [48, 32], intrinsics: {fx: 100}, pose: {rotate: [0, 0, 0]}" + camera +
        "}\n"
        "water: {bands: [620, 540, 450], absorption: [0, 0, 0], scattering: {b: [0, 0, 0], phase: "
        "{type: hg, g: 0.9}}}\n"
        "geometry:\n"
        "  - type: box\n"
        "    min: [-0.03, -0.1, 1]\n"
        "    max: [0.03, 0.1, 1.0001]\n"
        "    trajectory: {interpolation: linear, keyframes: [{time: 0, position: [" +
        std::to_string(-velocity) + ", 0, 0], rotate: [0, 0, 0]}, {time: 2, position: [" +
        std::to_string(velocity) +
        ", 0, 0], rotate: [0, 0, 0]}]}\n"
        "lamps: [{name: far, frame: world, position: [0, 0, -99], direction: [0, 0, 1], profile: "
        "{type: isotropic}, intensity: [1e4, 1e4, 1e4]}]\n"
        "render: {fps: 10, " +
        render + "}\n");
}

/// The mean over a pixel, its centre at `x` from the bar's middle, and over the exposure of a bar
/// of unit brightness: three boxes convolved, a sum of squares.
double trapezoid(double x, double width, double way) {
    double sum = 0;
    for (const double a : {-1.0, 1.0})
        for (const double b : {-1.0, 1.0})
            for (const double c : {-1.0, 1.0}) {
                const double t = std::max(0.0, x + 0.5 * (a * width + b * way + c));
                sum += a * b * c * t * t / 2;
            }
    return sum / way;
}

TEST(MovingBar, IsATrapezoidAndKeepsItsLight) {
    const Film sharp = image_of(bar_scene(0, "samples: 256"), {});
    for (const double way : {3.0, 9.0, 20.0}) {  // pixels
        const double velocity = way / 100 / k_shutter;
        const Film blurred = image_of(bar_scene(velocity, "samples: 512, shutter: 0.04"), {});
        const double bright = static_cast<double>(sharp.pixel(24, 16)[0]);
        ASSERT_GT(bright, 0);
        double sum = 0, before = 0;
        for (int x = 0; x < 48; ++x) {
            const double expected = trapezoid(x + 0.5 - 24, 6, way);
            for (int y = 0; y < 32; ++y) {
                const double value = static_cast<double>(blurred.pixel(x, y)[0]) / bright;
                // Surfaces stand still in parts of the exposure in which they move by half a pixel:
                // the ramp of 1 / way per pixel is made of steps, each off by up to half of its
                // height at an edge, by half of that in the mean over a pixel. Samples add up to
                // 0.01.
                if (y > 7 && y < 24) {
                    EXPECT_NEAR(value, expected, 0.0625 / way + 0.01) << x << " " << way;
                }
                sum += value;
                before += static_cast<double>(sharp.pixel(x, y)[0]) / bright;
            }
        }
        EXPECT_NEAR(sum / before, 1, 0.004) << way;
    }
}

TEST(MovingBar, CostsNothingWhereNothingMoves) {
    const RenderOptions layers{.layers = "direct,backscatter,depth"};
    // Something has a trajectory, but stands still.
    const Film open = image_of(bar_scene(0, "shutter: 0.04"), layers);
    EXPECT_TRUE(
        std::ranges::equal(open.values(), image_of(bar_scene(0, "samples: 4"), layers).values()));
    Renderer renderer;
    renderer.set_scene(bar_scene(0, "shutter: 0.04"));
    renderer.render(layers);
    EXPECT_EQ(renderer.report().exposure_parts, 0);
}

TEST(MovingBar, IsCountedBySensorsAsItIsBlurred) {
    const auto bar = [](double velocity) {
        return image_of(
            bar_scene(velocity, "samples: 512, shutter: 0.04",
                      ", lens: {f_number: 2.8, focal_length: 0.008}, sensor: {gain: 0.002, "
                      "bit_depth: 16, shot_noise: false, quantum_efficiency: 0.6}"),
            {.layers = "sensor"});
    };
    const Film blurred = bar(5), sharp = bar(0);
    const std::size_t k = blurred.channel_names().size() - 1;
    ASSERT_EQ(blurred.channel_names()[k], "sensor.V");
    const double bright = static_cast<double>(sharp.pixel(24, 16)[k]);
    ASSERT_GT(bright, 100);
    // A bar of 6 pixels on a way of 20 covers a pixel for 0.3 of the time; two numbers are rounded.
    EXPECT_NEAR(static_cast<double>(blurred.pixel(24, 16)[k]) / bright, 0.3, 0.02);
}

}  // namespace
}  // namespace uw::test
