// ctest labels: unit analytic
//
// What moves while the shutter is open is blurred: against the mean over many instants, each
// rendered by itself. Ground truth stays that of the exposure's middle.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "render/renderer.h"
#include "render/resolved_scene.h"
#include "render/scene_loading.h"
#include "tests/support/message_of.h"

namespace uw::test {
namespace {

// Frame 10 is at 1 s; the shutter is open from 0.98 s to 1.02 s.
constexpr int k_frame = 10;
constexpr double k_shutter = 0.04;

Film image_of(SceneDesc desc, const RenderOptions& options) {
    Renderer renderer;
    renderer.set_scene(std::move(desc));
    renderer.render(options);
    return renderer.release_film();
}

enum class Moves { all, camera_alone };

/// Camera, lamps and box move, each in its own way, in water.
SceneDesc moving_scene(const std::string& render, const std::string& water = "",
                       Moves moves = Moves::all) {
    SceneDesc scene = load_scene_text(
        "uwvdb: 1\n"
        "camera: {resolution: [40, 36], intrinsics: {fx: 40}, port: {distance: 0.02, thickness: "
        "0.02}, lens: {f_number: 2.8, focal_length: 0.008}, trajectory: {keyframes: [{time: 0, "
        "position: [-3, 0.2, 0], rotate: [0, 40, 0]}, {time: 1, position: [0, 0, 0], rotate: [0, "
        "0, 0]}, {time: 2, position: [3, 0.1, 0.5], rotate: [10, -40, 5]}]}}\n"
        "water: {bands: [620, 540, 450], absorption: [0.35, 0.08, 0.05], scattering: {b: [0.2, "
        "0.22, 0.25], phase: {type: hg, g: 0.8}}" +
            water +
            "}\n"
            "geometry:\n"
            "  - {type: plane, point: [0, 0, 3], normal: [0.1, 0, -1]}\n"
            "  - type: box\n"
            "    min: [-0.2, -0.3, 1.2]\n"
            "    max: [0.2, 0.3, 1.4]\n"
            "    reflectance: [0.9, 0.6, 0.2]\n"
            "    trajectory: {keyframes: [{time: 0, position: [0, 2, 0], rotate: [0, 0, 0]}, "
            "{time: 2, "
            "position: [0, -2, 0], rotate: [0, 0, 90]}]}\n"
            "lamps:\n"
            "  - {name: own, position: [0.4, -0.3, 0], direction: [0, 0, 1], profile: {type: spot, "
            "beam: 70, edge: 20}, intensity: [40, 40, 40]}\n"
            "  - name: free\n"
            "    frame: world\n"
            "    position: [0, 0, 0]\n"
            "    direction: [0, 0, 1]\n"
            "    profile: {type: isotropic}\n"
            "    intensity: [20, 20, 20]\n"
            "    trajectory: {keyframes: [{time: 0, position: [-2, -0.5, 0.3], rotate: [0, 0, 0]}, "
            "{time: 2, position: [2, -0.5, 0.3], rotate: [0, 0, 0]}]}\n"
            "render: {fps: 10" +
            render + "}\n",
        "scene.yaml");
    if (moves == Moves::camera_alone) {
        scene.geometry[1].trajectory.reset();
        for (LampDesc& lamp : scene.lamps) {
            lamp.trajectory.reset();
            lamp.fixed_to_camera = false;
        }
    }
    return scene_of_image(scene, {k_frame});
}

/// The mean over instants in the middle of `count` equal parts of the shutter's time, and their
/// scene without a shutter.
std::vector<double> mean_over_instants(const SceneDesc& scene, int count,
                                       const RenderOptions& options) {
    std::vector<double> mean;
    for (int i = 0; i < count; ++i) {
        SceneDesc instant = scene_at(scene, *scene.time + k_shutter * ((i + 0.5) / count - 0.5));
        instant.render.shutter = 0;
        const Film film = image_of(std::move(instant), options);
        mean.resize(film.values().size());
        for (std::size_t k = 0; k < mean.size(); ++k)
            mean[k] += static_cast<double>(film.values()[k]) / count;
    }
    return mean;
}

/// RMS of the difference of some channels over the mean of those expected.
double error_of(const Film& film, const std::vector<double>& expected, std::size_t first,
                std::size_t count) {
    const std::size_t stride = film.channel_names().size();
    double squares = 0, mean = 0;
    std::size_t n = 0;
    for (std::size_t pixel = 0; pixel < film.values().size(); pixel += stride)
        for (std::size_t k = pixel + first; k < pixel + first + count; ++k, ++n) {
            squares += std::pow(static_cast<double>(film.values()[k]) - expected[k], 2);
            mean += expected[k];
        }
    const auto values = static_cast<double>(n);
    return std::sqrt(squares / values) / (mean / values);
}

std::vector<double> values_of(const Film& film) {
    return {film.values().begin(), film.values().end()};
}

// The greatest errors of total, direct light, backscatter, irradiance and clean.
void check_mean_over_instants(Moves moves, const std::array<double, 5>& tolerances) {
    const RenderOptions layers{.layers = "direct,backscatter,irradiance,clean"};
    const SceneDesc blurred = moving_scene(", samples: 256, shutter: 0.04", "", moves);
    SceneDesc sharp = blurred;
    sharp.render.shutter = 0;
    sharp.render.samples = 16;
    const std::vector<double> truth = mean_over_instants(sharp, 64, layers);
    Renderer renderer;
    renderer.set_scene(SceneDesc(blurred));
    const Film& film = renderer.render(layers);
    const Film still = image_of(sharp, layers);
    // The first three channels are the total, then there is A.
    constexpr std::array<std::size_t, 5> k_first{0, 4, 7, 10, 13};
    for (std::size_t i = 0; i < k_first.size(); ++i) {
        const double error = error_of(film, truth, k_first[i], 3);
        EXPECT_LT(error, tolerances[i]) << film.channel_names()[k_first[i]];
        // And it is no small effect.
        EXPECT_GT(error_of(still, truth, k_first[i], 3), 3 * error);
    }
}

TEST(MotionBlur, IsTheMeanOverInstants) {
    // 256 samples, each at its own time, of which an edge in a pixel sees a quarter, and 64
    // instants, whose edges are a tenth of a pixel apart: 1 %. The water stands still for up to 4
    // pixels, also where it ends at the box.
    check_mean_over_instants(Moves::camera_alone, {0.01, 0.01, 0.015, 0.01, 0.01});
    // In parts of the exposure surfaces stand still for half a pixel and lamps for two, so that
    // edges and shadows are steps of up to a quarter and one pixel: in some of the image's columns
    // an error of a tenth of the light.
    check_mean_over_instants(Moves::all, {0.03, 0.03, 0.01, 0.03, 0.03});
}

TEST(MotionBlur, IsThatOfEveryIntegrator) {
    for (const std::string integrator : {"planes", "reference", "path"}) {
        SCOPED_TRACE(integrator);
        const std::string common = ", shutter: 0.04, samples: ";
        SceneDesc volume = moving_scene(common + "64");
        SceneDesc other =
            moving_scene(common + (integrator == "path" ? "1024, scattering: multiple" : "64") +
                         ", integrator: " + integrator);
        const PixelWindow window{12, 10, 28, 26};
        const RenderOptions options{.layers = "direct,backscatter", .window = window};
        const Film a = image_of(volume, options), b = image_of(other, options);
        // Planes have 64 slabs, paths noise of 1 / sqrt(1024) of a term that varies by its size.
        EXPECT_LT(error_of(b, values_of(a), 4, 3), integrator == "path" ? 0.04 : 0.02);
        EXPECT_LT(error_of(b, values_of(a), 7, 3), integrator == "reference" ? 0.01 : 0.04);
    }
}

TEST(MotionBlur, LeavesLayersThatAddUpToTheTotal) {
    struct Case {
        std::string render, water, layers;
    };
    for (const Case& c :
         {Case{"", "", "direct,forward,backscatter"},
          Case{"", ", forward_scatter: {K: 0.2, G: 0.1, B: 0.1}", "direct,forward,backscatter"},
          Case{", scattering: multiple", "",
               "direct,forward,backscatter,multiple,multiple.volume,multiple.surface"},
          Case{", integrator: path", "",
               "direct,forward,backscatter,multiple,multiple.volume,multiple.surface"}}) {
        SCOPED_TRACE(c.render + c.water);
        SceneDesc scene = moving_scene(", samples: 8, shutter: 0.04" + c.render, c.water);
        scene.render.quality = RenderDesc::Quality::draft;
        const Film film = image_of(scene, {.layers = c.layers});
        const bool multiple = film.channel_names().size() > 13;
        int lit = 0;
        for (int y = 0; y < film.height(); ++y)
            for (int x = 0; x < film.width(); ++x)
                for (std::size_t b = 0; b < 3; ++b) {
                    const auto p = film.pixel(x, y);
                    float sum = p[4 + b] + p[7 + b] + p[10 + b];
                    if (multiple) {
                        EXPECT_EQ(p[13 + b], p[16 + b] + p[19 + b]);
                        sum += p[13 + b];
                    }
                    EXPECT_EQ(p[b], sum);
                    lit += p[b] > 0 ? 1 : 0;
                }
        EXPECT_GT(lit, 4000);
    }
}

TEST(MotionBlur, LeavesGroundTruthAsItIsInTheMiddle) {
    const RenderOptions layers{
        .layers = "albedo,depth,range,path,normal,position,id,flow,flow_back,flow_occluded"};
    const Film sharp = image_of(moving_scene(", samples: 4"), layers);
    const Film blurred = image_of(moving_scene(", samples: 4, shutter: 0.04"), layers);
    int differ = 0;
    for (int y = 0; y < sharp.height(); ++y)
        for (int x = 0; x < sharp.width(); ++x) {
            const auto a = sharp.pixel(x, y), b = blurred.pixel(x, y);
            for (std::size_t k = 4; k < a.size(); ++k)
                EXPECT_TRUE(a[k] == b[k] || (std::isnan(a[k]) && std::isnan(b[k])))
                    << sharp.channel_names()[k];
            differ += a[0] != b[0] ? 1 : 0;
        }
    EXPECT_GT(differ, 1000);
}

TEST(MotionBlur, IsTheSameForThreadsAndCrops) {
    const SceneDesc scene = moving_scene(", samples: 16, shutter: 0.04");
    const RenderOptions layers{.layers = "direct,backscatter,transmittance,depth"};
    const Film whole = image_of(scene, layers);
    {
        const ThreadLimit one(1);
        EXPECT_TRUE(std::ranges::equal(image_of(scene, layers).values(), whole.values()));
    }
    const PixelWindow window{5, 3, 37, 34};
    const Film part = image_of(scene, {.layers = layers.layers, .window = window});
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            EXPECT_TRUE(std::ranges::equal(part.pixel(x, y), whole.pixel(x, y)));
}

TEST(MotionBlur, GoesOnBeyondTheEndsOfATrajectory) {
    // At 0 s the bar begins to move from its middle: half of the exposure is before.
    SceneDesc all = load_scene_text(
        "uwvdb: 1\n"
        "camera: {resolution: [48, 4], intrinsics: {fx: 100}, trajectory: {interpolation: linear, "
        "keyframes: [{time: 0, rotate: [0, 0, 0]}, {time: 1, position: [3, 0, 0], rotate: [0, 90, "
        "0]}]}}\n",
        "scene.yaml");
    const SceneDesc first = scene_of_image(all, {0});
    const SceneDesc before = scene_at(first, -0.02), after = scene_at(first, 0.02);
    EXPECT_NEAR(before.camera.world_from_camera.offset().x, -0.06, 1e-12);
    const Affine both = before.camera.world_from_camera * after.camera.world_from_camera;
    EXPECT_NEAR(both.linear()[2][0], 0, 1e-12);  // as far round to one side as to the other
}

TEST(MotionBlur, OfLightPathsRefusesAnErrorToReach) {
    Renderer renderer;
    renderer.set_scene(moving_scene(", integrator: path, shutter: 0.04"));
    const std::string message =
        message_of<UsageError>([&] { renderer.render({.paths = {.error = 0.02}}); });
    EXPECT_NE(message.find("--samples"), std::string::npos);
}

}  // namespace
}  // namespace uw::test
