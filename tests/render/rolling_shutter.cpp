// ctest labels: unit analytic
//
// Rows that are exposed one after the other: each sees the scene of its own time, and its ground
// truth is that of the middle of its exposure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "render/image_scene.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/image_laws.h"
#include "tests/support/message_of.h"

namespace uw::test {
namespace {

constexpr int k_width = 60, k_height = 40;
constexpr double k_line = 0.0005;  // s

SceneDesc load(const std::string& text) {
    return load_scene_text("uwvdb: 1\n" + text, "scene.yaml");
}

/// A camera at 2 m/s to the right, that passes the origin in frame 10 at 1 s, and a pole of 0.1 m
/// at 2 m before a wall at 8 m.
SceneDesc pole_scene(const std::string& camera, const std::string& render,
                     const std::string& pole = "") {
    return load(
        "camera: {resolution: [60, 40], intrinsics: {fx: 100}, " + camera +
        "trajectory: {interpolation: linear, keyframes: [{time: 0, position: [-2, 0, 0], "
        "rotate: [0, 0, 0]}, {time: 2, position: [2, 0, 0], rotate: [0, 0, 0]}]}}\n"
        "geometry:\n"
        "  - {type: plane, point: [0, 0, 8], normal: [0, 0, -1], reflectance: 0.02}\n"
        "  - {type: box, min: [-0.05, -9, 2], max: [0.05, 9, 2.001], reflectance: 0.9" +
        pole +
        "}\n"
        "lamps: [{name: lamp, position: [0, -0.5, 0], direction: [0, 0, 1], profile: {type: "
        "isotropic}, intensity: [10, 10, 10]}]\n"
        "render: {fps: 10, " +
        render + "}\n");
}

// The time of a row's middle after that of the frame [s].
double time_of_row(int y) {
    return (y + 0.5 - 0.5 * k_height) * k_line;
}

/// In row y the pole is where the camera of that time sees it: v t f / Z to the left, with edges
/// 5 pixels around.
TEST(RollingShutter, LeansAPole) {
    const ImageScene scene = scene_of_image(pole_scene("line_time: 0.0005, ", "samples: 64"), {10});
    const Film film = image_of(scene, {.layers = "clean,depth,id"});
    for (int y = 0; y < k_height; ++y) {
        const double t = time_of_row(y);
        const double middle = 30 - 2 * t * 100 / 2;
        double light = 0, moment = 0;
        for (int x = 0; x < k_width; ++x) {
            const auto p = film.pixel(x, y);
            const bool on_pole = std::abs(x + 0.5 - middle) < 2.5;
            EXPECT_EQ(p[8] == 2, on_pole) << x << ", " << y;
            // Depth is across the camera's axis, which goes on straight.
            EXPECT_NEAR(p[7], on_pole ? 2 : 8, 1e-5) << x << ", " << y;
            // The wall has 0.02 / 0.9 / 16 of the pole's light.
            const double weight = std::max(0.0, static_cast<double>(p[4]) - 0.02);
            light += weight;
            moment += weight * (x + 0.5);
        }
        // Samples are at 1/64 of a pixel's width.
        EXPECT_NEAR(moment / light, middle, 0.03) << y;
    }
}

TEST(RollingShutter, BlursEachRowOverItsOwnExposure) {
    // 20 ms: the pole moves by 2 px, over all rows by 4.
    const ImageScene scene =
        scene_of_image(pole_scene("line_time: 0.0005, ", "samples: 256, shutter: 0.02"), {10});
    const ImageScene instants = scene.with([](SceneDesc& desc) { desc.render.shutter = 0; });
    const Film film = image_of(scene, {.layers = "clean"});
    const Film sharp = image_of(instants, {.layers = "clean"});
    for (int y = 0; y < k_height; ++y) {
        const double middle = 30 - 100 * time_of_row(y);
        const double bright = static_cast<double>(sharp.pixel(static_cast<int>(middle), y)[4]);
        double light = 0, moment = 0;
        for (int x = 0; x < k_width; ++x) {
            const double at = x + 0.5 - middle;
            // A trapezoid, its edges rounded off by the pixel: compared where it is flat.
            const double value = static_cast<double>(film.pixel(x, y)[4]) / bright;
            if (std::abs(at) < 1) {
                EXPECT_NEAR(value, 1, 0.02) << x << ", " << y;
            }
            if (std::abs(at) > 4) {
                EXPECT_LT(value, 0.1) << x << ", " << y;
            }
            const double weight = std::max(0.0, value - 0.05);
            light += weight;
            moment += weight * (x + 0.5);
        }
        EXPECT_NEAR(moment / light, middle, 0.05) << y;
    }
}

/// Whatever moves: each row is that of the scene of its own time.
TEST(RollingShutter, RowsAreThoseOfInstants) {
    const std::string pole =
        ", trajectory: {keyframes: [{time: 0, position: [2, 0, 0.5], rotate: [0, 0, 0]}, {time: "
        "2, position: [-2, 0, -0.5], rotate: [0, 0, 0]}]}";
    const ImageScene rolling =
        scene_of_image(pole_scene("line_time: 0.0005, ", "samples: 16", pole), {10});
    const RenderOptions layers{.layers = "direct,backscatter,clean,depth,position,id"};
    const Film film = image_of(rolling, layers);
    for (const int y : {0, 7, 20, 33, 39}) {
        const ImageScene instant =
            rolling.at(1 + time_of_row(y)).with([](SceneDesc& desc) { desc.camera.line_time = 0; });
        const Film row = image_of(instant, layers);
        double difference = 0, sum = 0, off = 0;
        for (int x = 0; x < k_width; ++x) {
            const auto a = film.pixel(x, y), b = row.pixel(x, y);
            for (std::size_t k = 4; k < 13; ++k) {
                difference += std::abs(static_cast<double>(a[k]) - static_cast<double>(b[k]));
                sum += static_cast<double>(b[k]);
            }
            for (std::size_t k = 13; k < a.size(); ++k)
                off += std::abs(static_cast<double>(a[k]) - static_cast<double>(b[k])) >
                               0.01 * std::abs(static_cast<double>(b[k])) + 0.01
                           ? 1
                           : 0;
        }
        // Surfaces are those of parts of the time, up to a quarter of a pixel aside at both edges
        // of a pole of 5 pixels: 10 %. Over all rows it goes by 4.
        EXPECT_LT(difference, 0.1 * sum) << y;
        EXPECT_LE(off, 10) << y;  // the five numbers of a pixel at each edge
    }
}

/// The flow from frame 10 to 11 leads to the row that is exposed when the point is there: found by
/// bisection over the rows, each with the camera of its own time.
TEST(RollingShutter, FlowLeadsToTheRowThatIsExposedThen) {
    const SceneDesc all = load(
        "camera: {resolution: [60, 40], intrinsics: {fx: 60}, port: {distance: 0.02, thickness: "
        "0.02}, line_time: 0.0005, trajectory: {keyframes: [{time: 0.8, position: [-0.2, 0, 0], "
        "rotate: [0, -4, 0]}, {time: 1, position: [0, 0.02, 0], rotate: [2, 0, 0]}, {time: 1.2, "
        "position: [0.2, 0.1, 0.1], rotate: [10, 6, 4]}]}}\n"
        "geometry:\n"
        "  - {type: plane, point: [0, 0, 3], normal: [0.1, 0.2, -1]}\n"
        "render: {samples: 1, fps: 10}\n");
    const ImageScene now = scene_of_image(all, {10}), next = scene_of_image(all, {11});
    const Film film = image_of(now, {.layers = "position,depth,flow,flow_back"});
    double largest = 0;
    for (int y = 1; y < k_height; y += 6)
        for (int x = 2; x < k_width; x += 7) {
            const auto p = film.pixel(x, y);
            // Channels are in the order of the layers: depth, position, flow, flow_back.
            const Point3 point{p[5], p[6], p[7]};
            const auto seen_at = [&](const ImageScene& frame, double row) {
                const ImageScene instant =
                    frame.at(*frame.time() + (row - 0.5 * k_height) * k_line);
                return Camera(instant.desc().camera).project(point).value();
            };
            // Its own row sees it at its own place.
            const ImagePoint own = seen_at(now, y + 0.5);
            EXPECT_NEAR(own.x, x + 0.5, 1e-3);
            EXPECT_NEAR(own.y, y + 0.5, 1e-3);
            double low = -40, high = 80;
            for (int i = 0; i < 50; ++i) {
                const double row = 0.5 * (low + high);
                (seen_at(next, row).y > row ? low : high) = row;
            }
            const ImagePoint then = seen_at(next, low);
            EXPECT_NEAR(p[8], then.x - (x + 0.5), 1e-3) << x << ", " << y;
            EXPECT_NEAR(p[9], then.y - (y + 0.5), 1e-3) << x << ", " << y;
            // A shutter that does not roll would see it elsewhere.
            largest = std::max(largest, std::abs(then.x - seen_at(next, 20).x));
        }
    EXPECT_GT(largest, 0.2);
}

TEST(RollingShutter, DisparityIsThatOfTheRowsOfBothCameras) {
    const SceneDesc all = load(
        "cameras:\n"
        "  - {name: left, resolution: [60, 40], intrinsics: {fx: 60}, line_time: 0.0005, pose: "
        "{rotate: [0, 0, 0]}}\n"
        "  - {name: right, resolution: [60, 40], intrinsics: {fx: 60}, line_time: 0.0005, pose: "
        "{position: [0.1, 0, 0], rotate: [0, 0, 0]}}\n"
        "rig: {trajectory: {interpolation: linear, keyframes: [{time: 0, position: [0, -2, 0], "
        "rotate: [0, 0, 0]}, {time: 2, position: [0, 2, 0], rotate: [0, 0, 0]}]}}\n"
        "geometry: [{type: plane, point: [0, 0, 3], normal: [0, 0, -1]}]\n"
        "render: {samples: 1, fps: 10}\n");
    const Film film = image_of(scene_of_image(all, {10, 0}), {.layers = "depth,disparity"});
    for (int y = 0; y < k_height; ++y) {
        // Both rows are exposed at the same time: as if nothing moved, b f / Z.
        EXPECT_NEAR(film.pixel(30, y)[4], 3, 1e-5);
        EXPECT_NEAR(film.pixel(30, y)[5], 0.1 * 60 / 3, 1e-4);
        EXPECT_NEAR(film.pixel(30, y)[6], 0, 1e-4);
    }
}

TEST(RollingShutter, RefusesFlowOfSurfacesThatMove) {
    const std::string pole =
        ", trajectory: {keyframes: [{time: 0, rotate: [0, 0, 0]}, {time: 2, position: [1, 0, 0], "
        "rotate: [0, 0, 0]}]}";
    const ImageScene scene =
        scene_of_image(pole_scene("line_time: 0.0005, ", "samples: 1", pole), {10});
    const std::string message =
        message_of<InputError>([&] { image_of(scene, {.layers = "flow"}); });
    EXPECT_NE(message.find("scene.yaml:2:9: camera.line_time: with a rolling shutter there is no "
                           "flow"),
              std::string::npos)
        << message;
}

TEST(RollingShutter, IsTheSameForThreadsAndCrops) {
    const ImageScene scene =
        scene_of_image(pole_scene("line_time: 0.0005, ", "samples: 8, shutter: 0.02"), {10});
    expect_same_for_threads_and_windows(scene, {.layers = "direct,backscatter,depth,flow"},
                                        {5, 13, 37, 34});
}

}  // namespace
}  // namespace uw::test
