// ctest labels: unit analytic slow
//
// What moves while the shutter is open is blurred, whatever integrates its light. Ground truth
// stays that of the exposure's middle. Against the mean over instants: motion_blur_mean.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "render/scene_loading.h"
#include "tests/support/image_laws.h"
#include "tests/support/message_of.h"
#include "tests/support/motion/moving_scene.h"

namespace uw::test {
namespace {

TEST(MotionBlur, IsThatOfEveryIntegrator) {
    const std::string common = ", shutter: 0.04, samples: ";
    const PixelWindow window{12, 10, 28, 26};
    const RenderOptions options{.layers = "direct,backscatter", .window = window};
    const Film a = image_of(moving_scene(common + "64"), options);
    for (const std::string integrator : {"planes", "reference", "path"}) {
        SCOPED_TRACE(integrator);
        const ImageScene other =
            moving_scene(common + (integrator == "path" ? "1024, scattering: multiple" : "64") +
                         ", integrator: " + integrator);
        const Film b = image_of(other, options);
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
          Case{"", ", snow: {number: 4000, diameter: [2 mm, 9 mm], exponent: 4, reflectance: 0.05}",
               "direct,forward,backscatter,snow"},
          Case{", scattering: multiple", "",
               "direct,forward,backscatter,multiple,multiple.volume,multiple.surface"},
          Case{", integrator: path", "",
               "direct,forward,backscatter,multiple,multiple.volume,multiple.surface"}}) {
        SCOPED_TRACE(c.render + c.water);
        const ImageScene scene =
            moving_scene(", samples: 8, shutter: 0.04" + c.render, c.water)
                .with([](SceneDesc& desc) { desc.render.quality = RenderDesc::Quality::draft; });
        const Film film = image_of(scene, {.layers = c.layers});
        EXPECT_GT(expect_components_add_up(film), 4000);
        if (c.water.starts_with(", snow")) {
            EXPECT_GT(std::ranges::count_if(film.values(), [](float v) { return v < 0; }), 100)
                << "snow hides light";
        }
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
    const ImageScene scene = moving_scene(", samples: 16, shutter: 0.04");
    expect_same_for_threads_and_windows(scene, {.layers = "direct,backscatter,transmittance,depth"},
                                        {5, 3, 37, 34});
}

TEST(MotionBlur, GoesOnBeyondTheEndsOfATrajectory) {
    // At 0 s the bar begins to move from its middle: half of the exposure is before.
    SceneDesc all = load_scene_text(
        "uwvdb: 1\n"
        "camera: {resolution: [48, 4], intrinsics: {fx: 100}, trajectory: {interpolation: linear, "
        "keyframes: [{time: 0, rotate: [0, 0, 0]}, {time: 1, position: [3, 0, 0], rotate: [0, 90, "
        "0]}]}}\n",
        "scene.yaml");
    const ImageScene first = scene_of_image(all, {0});
    const Affine before = first.at(-0.02).desc().camera.world_from_camera;
    const Affine after = first.at(0.02).desc().camera.world_from_camera;
    EXPECT_NEAR(before.offset().x, -0.06, 1e-12);
    const Affine both = before * after;
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
