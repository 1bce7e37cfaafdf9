// ctest labels: unit metamorphic slow
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "camera/camera.h"
#include "core/scene/scene_desc.h"
#include "tests/support/cli_test.h"

namespace uw {
namespace {

using test::ImageFile;

class WideCameras : public test::CliTest {};

// A wall and a box all around, of which every ray in the water meets something.
constexpr const char* k_room = R"(
water: {absorption: 0, scattering: {b: 0, phase: {type: water}}}
geometry:
  - {type: box, min: [-3, -2.5, -2], max: [4, 3, 5], reflectance: 0.5}
  - {type: sphere, center: [0.3, -0.2, 1.5], radius: 0.4, reflectance: 0.5}
lamps:
  - {position: [0.2, 0.3, 0.1], intensity: 10}
)";

// Layer `position` of a rendered image, projected back.
TEST_F(WideCameras, PositionsReprojectToThePixelCentres) {
    const std::string port_flat =
        "port: {normal: [0.05, -0.1, 1], distance: 0.02, thickness: 0.04}";
    const std::string port_dome =
        "port: {type: dome, center: [0.004, 0.002, -0.01], radius: 0.05, thickness: 0.007}";
    const std::string pinhole = "intrinsics: {fx: 60, cx: 47, cy: 33}";
    const std::string fisheye =
        "intrinsics: {fov_x: 200}, distortion: {model: fisheye, "
        "k: [0.02, -0.003, 0, 0]}";
    for (const std::string& lens : {pinhole, fisheye}) {
        for (const std::string& port :
             {std::string("lens: {f_number: 2, focal_length: 0.01}"), port_flat, port_dome}) {
            write("room.yaml", "uwvdb: 1\ncamera: {resolution: [96, 64], " + lens + ", " + port +
                                   ", pose: {position: [0.1, 0.2, -0.3], look_at: [0.4, 0, 2]}}" +
                                   k_room);
            const auto result =
                run({"render", "room.yaml", "-o", "room.exr", "--samples", "1", "--layers", "all"});
            ASSERT_EQ(result.exit_code, 0) << result.err;
            const ImageFile image = test::read_exr(folder_ / "room.exr");
            const Camera camera(read_scene(folder_ / "room.yaml", {}).camera);
            int seen = 0;
            double worst = 0;
            for (int y = 0; y < 64; ++y) {
                for (int x = 0; x < 96; ++x) {
                    if (image.at("id.V", x, y) == 0) continue;
                    ++seen;
                    const auto back =
                        camera.project({image.at("position.X", x, y), image.at("position.Y", x, y),
                                        image.at("position.Z", x, y)});
                    ASSERT_TRUE(back) << port << " " << x << " " << y;
                    worst = std::max(worst, std::hypot(back->x - x - 0.5, back->y - y - 0.5));
                }
            }
            EXPECT_GT(seen, 96 * 64 / 3) << lens << port;
            // Floats of up to 5 m are rounded by 2e-7 m; at 1 m and 60 pixels a radian that is
            // 1.4e-5 pixel.
            EXPECT_LT(worst, 1e-4) << lens << port;
        }
    }
}

// In a horizontal circle around a camera with an isotropic lamp above it all directions are alike.
TEST_F(WideCameras, FisheyeSeesTheSameAllAroundALampAboveIt) {
    write("circle.yaml", R"(uwvdb: 1
camera: {resolution: [121, 3], intrinsics: {fx: 30}, distortion: {model: fisheye}}
water: {absorption: [0.35, 0.08, 0.05], scattering: {b: 0.2, phase: {type: hg, g: 0.8}}}
lamps: [{position: [0, -0.5, 0], intensity: 50}]
)");
    const auto spread = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render",     "circle.yaml", "-o",
                                           "circle.exr", "--layers",    "all"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        const ImageFile image = test::read_exr(folder_ / "circle.exr");
        float least = 1e30F, most = 0;
        for (int x = 0; x < 121; ++x) {
            const float here = image.at("backscatter.G", x, 1);
            least = std::min(least, here);
            most = std::max(most, here);
        }
        EXPECT_GT(least, 0);
        return (most - least) / most;
    };
    EXPECT_LT(spread({"--quality", "exact"}), 1e-4);  // the integral's own error
    // The blur is some tenths of a pixel wide; image rows differ from circles by as much.
    EXPECT_LT(spread({"--set", "water.forward_scatter={K: 1, B: 0.002}"}), 0.02);
}

TEST_F(WideCameras, FisheyePixelIsThatOfAPinholeTurnedThere) {
    write("fisheye.yaml", std::string(R"(uwvdb: 1
camera: {resolution: [101, 11], intrinsics: {fx: 28.6478897565412}, distortion: {model: fisheye}}
water: {preset: jerlov-II}
geometry:
  - {type: box, min: [-3, -2.5, -2], max: [4, 3, 5], reflectance: 0.5}
lamps:
  - {position: [0.2, 0.3, 0.1], intensity: 10, frame: world}
)"));  // 90 / pi pixels a radian: pixel 50 + 45 looks at a right angle
    write("pinhole.yaml", R"(uwvdb: 1
camera: {resolution: [1, 1], intrinsics: {fx: 100}, pose: {position: [0, 0, 0], look_at: [1, 0, 0]}}
water: {preset: jerlov-II}
geometry:
  - {type: box, min: [-3, -2.5, -2], max: [4, 3, 5], reflectance: 0.5}
lamps:
  - {position: [0.2, 0.3, 0.1], intensity: 10, frame: world}
)");
    for (const char* name : {"fisheye", "pinhole"}) {
        const std::string stem(name);
        const auto result = run({"render", stem + ".yaml", "-o", stem + ".exr", "--layers", "all",
                                 "--quality", "exact", "--samples", "1"});
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    const ImageFile fisheye = test::read_exr(folder_ / "fisheye.exr");
    const ImageFile pinhole = test::read_exr(folder_ / "pinhole.exr");
    for (const char* channel : {"R", "G", "B", "backscatter.G", "direct.B", "range.V"}) {
        const double truth = pinhole.at(channel, 0, 0);
        EXPECT_NEAR(fisheye.at(channel, 95, 5) / truth, 1, 1e-5) << channel;
    }
    EXPECT_NEAR(fisheye.at("depth.Z", 95, 5), 0, 1e-6);
    EXPECT_GT(fisheye.at("id.V", 100, 5), 0);
    EXPECT_LT(fisheye.at("depth.Z", 100, 5), 0);
}

TEST_F(WideCameras, SensorIrradianceOfAFisheyeHasNoCosines) {
    write("fisheye.yaml", std::string("uwvdb: 1\ncamera: {resolution: [96, 64], intrinsics: "
                                      "{fov_x: 200}, distortion: {model: fisheye}, lens: "
                                      "{f_number: 2, focal_length: 0.0001}}") +
                              k_room);
    const auto render = [&](const char* output) {
        const auto result = run({"render", "fisheye.yaml", "-o", "out.exr", "--set",
                                 std::string("render.output=") + output, "--samples", "1"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return test::read_exr(folder_ / "out.exr");
    };
    const ImageFile radiance = render("radiance");
    const ImageFile sensor = render("sensor_irradiance");
    const double scale = 96 / 200.0 * 180 / std::numbers::pi;  // pixels a radian
    for (const int x : {48, 70, 90, 95}) {
        const double theta = std::hypot(x + 0.5 - 48, 0.5) / scale;
        const double falloff = std::sin(theta) / theta;
        EXPECT_NEAR(sensor.at("R", x, 32) / radiance.at("R", x, 32),
                    std::numbers::pi / 16 * falloff, 1e-3 * falloff)
            << x;  // (R - F)^2 / R^2 is 1 to 2e-4
    }
}

TEST_F(WideCameras, WhatAFisheyeCannotDoIsRefused) {
    const std::string camera = "camera.distortion={model: fisheye}";
    expect_failure({"render", "scene.yaml", "--set", camera, "--integrator", "planes"}, 3,
                   "the planes integrator sums over slabs parallel to the image plane");
    expect_failure({"validate", "scene.yaml", "--set", camera, "--quiet"}, 3,
                   "but a fisheye lens can see past them");
}

TEST_F(WideCameras, FullCircleFisheyeIsBlackOutside) {
    const ImageFile image = render({"--set", "camera.distortion={model: fisheye}", "--set",
                                    "camera.intrinsics={fx: 2.5}", "--layers", "all"});
    for (int y = 0; y < 19; ++y)
        for (int x = 0; x < 33; ++x) {
            const double r = std::hypot(x - 16, y - 9);
            // Half a pixel of samples around the edge at 180 degrees.
            if (std::abs(r - 2.5 * std::numbers::pi) < 0.75) continue;
            EXPECT_EQ(image.at("A", x, y), r < 2.5 * std::numbers::pi ? 1 : 0) << x << " " << y;
        }
    for (const auto& [name, values] : image.channels)
        for (const float value : values) ASSERT_TRUE(std::isfinite(value)) << name;
}

}  // namespace
}  // namespace uw
