// ctest labels: metamorphic
// Snow before a camera that moves, whose exposure is divided into parts, and snow that drifts past
// one that does not, whose is not: the same motion, seen from the one or the other.
#include <gtest/gtest.h>

#include <cmath>

#include "render/image_scene.h"
#include "render/renderer.h"
#include "render/scene_loading.h"

namespace uw::test {
namespace {

struct SnowPicture {
    Film film;
    RenderReport report;
};

/// Frame 10, at 1 s, when the camera is where particles have drifted to.
SnowPicture picture_of(const std::string& camera, const std::string& drift) {
    const SceneDesc scene = load_scene_text(
        "uwvdb: 1\n"
        "camera: {resolution: [120, 90], intrinsics: {fx: 200}, " +
            camera +
            "}\n"
            "water:\n"
            "  bands: [620, 540, 450]\n"
            "  absorption: [0.35, 0.08, 0.05]\n"
            "  scattering: {b: [0.2, 0.22, 0.25], phase: {type: hg, g: 0.8}}\n"
            "  snow: {number: 2000, diameter: [1 mm, 5 mm], exponent: 4, reflectance: 0.5, "
            "drift: " +
            drift +
            "}\n"
            "lamps:\n"
            "  - {name: own, position: [0.4, -0.3, 0], intensity: [40, 40, 40]}\n"
            "render: {fps: 10, shutter: 0.1}\n",
        "scene.yaml");
    Renderer renderer;
    renderer.set_scene(scene_of_image(scene, {10}));
    renderer.render({.layers = "snow"});
    RenderReport report = renderer.report();
    return {renderer.release_film(), std::move(report)};
}

TEST(SnowInMotion, IsTheSameWhicheverMoves) {
    const SnowPicture drifting = picture_of(
        "pose: {position: [0.5, 0, 0], look_at: [0.5, 0, 1], up: [0, -1, 0]}", "[0.5, 0, 0]");
    const SnowPicture passing = picture_of(
        "trajectory: {keyframes: [{time: 0, position: [0.5, 0, 0], look_at: [0.5, 0, 1], up: [0, "
        "-1, 0]}, {time: 2, position: [-0.5, 0, 0], look_at: [-0.5, 0, 1], up: [0, -1, 0]}]}",
        "[0, 0, 0]");
    ASSERT_EQ(drifting.report.exposure_parts, 0U);
    ASSERT_GT(passing.report.exposure_parts, 2U);
    EXPECT_GT(passing.report.snow_particles, 100U);

    const std::size_t first = drifting.film.channel_names().size() - 3;
    ASSERT_EQ(passing.film.channel_names(), drifting.film.channel_names());
    for (std::size_t b = 0; b < 3; ++b) {
        double sum = 0, other_sum = 0, squares = 0, differences = 0;
        for (int y = 0; y < 90; ++y)
            for (int x = 0; x < 120; ++x) {
                const auto a = static_cast<double>(drifting.film.pixel(x, y)[first + b]);
                const auto c = static_cast<double>(passing.film.pixel(x, y)[first + b]);
                sum += a, other_sum += c;
                squares += a * a, differences += (c - a) * (c - a);
            }
        ASSERT_GT(sum, 0);
        // Light that a particle receives as it passes is that of the middle of its streak, or of
        // each part's: it varies by a few per cent over the 5 cm.
        EXPECT_NEAR(other_sum / sum, 1, 0.01) << "band " << b;
        EXPECT_LT(std::sqrt(differences / squares), 0.03) << "band " << b;
    }
}

}  // namespace
}  // namespace uw::test
