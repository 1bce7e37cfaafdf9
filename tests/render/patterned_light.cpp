// ctest labels: analytic
// Line lasers and projectors.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "camera/camera.h"
#include "render/renderer.h"
#include "render/scene_loading.h"

namespace uw::test {
namespace {

Film rendered(const std::string& scene, Renderer& renderer) {
    renderer.set_scene(load_scene_text(scene, "pattern.yaml"));
    renderer.render({.layers = "total"});
    return renderer.release_film();
}

// Behind a thick port, on a wall that the sheet meets at right angles, so that the line is even to
// both sides.
TEST(PatternedLight, ALineLiesWhereTheCameraProjectsIt) {
    const std::string scene =
        "uwvdb: 2\n"
        "camera:\n  resolution: [200, 120]\n  intrinsics: {fov_x: 60}\n"
        "  port: {type: flat, distance: 0.03, thickness: 0.02}\n"
        "water: {absorption: 0.05, scattering: {b: 0, phase: {type: hg, g: 0.9}}}\n"
        "geometry: [{type: plane, point: [0, 0, 1.5], normal: [0, 0, -1], reflectance: 0.5}]\n"
        "lamps: [{position: [0, -0.3, 0], profile: {type: line, angle: 50, width: 1}, "
        "intensity: 10}]\n"
        "render: {scattering: single, samples: 16}\n";
    Renderer renderer;
    const Film film = rendered(scene, renderer);
    const Camera camera(renderer.assembled().desc().camera);
    for (const int x : {40, 100, 163}) {
        double sum = 0, moment = 0;
        for (int y = 0; y < film.height(); ++y) {
            const double light = static_cast<double>(film.pixel(x, y)[k_green]);
            sum += light;
            moment += light * (y + 0.5);
        }
        ASSERT_GT(sum, 0);
        // Where the column's middle sees the wall at the line's height.
        double along = 0;
        for (int n = 0; n < 30; ++n)
            along += 0.005 * (x + 0.5 - camera.project({along, -0.3, 1.5})->x);
        const auto line = camera.project({along, -0.3, 1.5});
        ASSERT_NEAR(line->x, x + 0.5, 1e-3);
        EXPECT_NEAR(moment / sum, line->y, 0.01) << x;
    }
}

// All of its light falls on the wall.
// says.
TEST(PatternedLight, PowerIsThatOfAllDirections) {
    const std::string scene =
        "uwvdb: 2\n"
        "camera: {resolution: [64, 64], intrinsics: {fov_x: 120}}\n"
        "water: {absorption: 0, scattering: {b: 0, phase: {type: hg, g: 0.9}}}\n"
        "geometry: [{type: plane, point: [0, 0, 1], normal: [0, 0, -1], reflectance: 1}]\n"
        "lamps: [{position: [0, 0, 0], profile: {type: line, angle: 80, width: 6}, power: 3}]\n"
        "render: {scattering: single, samples: 64}\n";
    Renderer renderer;
    const Film film = rendered(scene, renderer);
    // The radiance of a white wall is E / pi, and the power the integral of E.
    const double pixel = 2 * std::tan(std::numbers::pi / 3) / 64;
    double power = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            power +=
                std::numbers::pi * static_cast<double>(film.pixel(x, y)[k_green]) * pixel * pixel;
    EXPECT_NEAR(power, 3, 0.01);  // the ends of the fan cross samples
}

// Lit by a sheet, the water's light along one ray is an integral over half a degree of the lamp.
TEST(PatternedLight, ASheetInWaterIsItsIntegral) {
    const std::string scene =
        "uwvdb: 2\n"
        "camera: {resolution: [9, 9], intrinsics: {fov_x: 40}}\n"
        "water: {absorption: 0.2, scattering: {b: 0.3, phase: {type: hg, g: 0.5}}}\n"
        "lamps: [{position: [0, -0.45, 0], direction: [0, 0.35, 1], intensity: 20, "
        "profile: {type: line, angle: 80, width: 0.5}}]\n"
        "render: {scattering: single}\n";
    Renderer renderer;
    const Film film = rendered(scene, renderer);
    const Vector3 axis = glm::normalize(Vector3(0, 0.35, 1)), normal = glm::cross(axis, {1, 0, 0});
    const double deviation = 0.5 * std::numbers::pi / 180 / std::sqrt(8 * std::numbers::ln2);
    for (const int x : {2, 4, 7})
        for (const int y : {3, 5}) {
            const double focal_length = 4.5 / std::tan(std::numbers::pi / 9);
            const Vector3 ray = glm::normalize(
                Vector3((x + 0.5 - 4.5) / focal_length, (y + 0.5 - 4.5) / focal_length, 1));
            constexpr double k_step = 1e-4;
            double light = 0;
            for (double s = 0.5 * k_step; s < 8; s += k_step) {
                const Vector3 from_lamp = s * ray - Vector3(0, -0.45, 0);
                const double distance = glm::length(from_lamp);
                const double off = std::asin(glm::dot(from_lamp, normal) / distance) / deviation;
                const double cosine = -glm::dot(from_lamp, ray) / distance;
                const double phase = 0.75 / (4 * std::numbers::pi * std::pow(1.25 - cosine, 1.5));
                light += 20 * std::exp(-0.5 * off * off) * 0.3 * phase *
                         std::exp(-0.5 * (distance + s)) / (distance * distance) * k_step;
            }
            EXPECT_NEAR(static_cast<double>(film.pixel(x, y)[k_green]), light, 2e-3 * light);
        }
}

}  // namespace
}  // namespace uw::test
