// ctest labels: analytic slow
//
// An image with motion blur is the mean over many instants, each rendered by itself.
#include <gtest/gtest.h>

#include <array>

#include "render/scene_loading.h"
#include "tests/support/motion/moving_scene.h"

namespace uw::test {
namespace {

/// The mean over instants in the middle of `count` equal parts of the shutter's time, and their
/// scene without a shutter.
std::vector<double> mean_over_instants(const ImageScene& scene, int count,
                                       const RenderOptions& options) {
    std::vector<double> mean;
    for (int i = 0; i < count; ++i) {
        const ImageScene instant = scene.at(*scene.time() + k_shutter * ((i + 0.5) / count - 0.5))
                                       .with([](SceneDesc& desc) { desc.render.shutter = 0; });
        const Film film = image_of(instant, options);
        mean.resize(film.values().size());
        for (std::size_t k = 0; k < mean.size(); ++k)
            mean[k] += static_cast<double>(film.values()[k]) / count;
    }
    return mean;
}

// The greatest errors of total, direct light, backscatter, irradiance and clean.
void check_mean_over_instants(Moves moves, const std::array<double, 5>& tolerances) {
    const RenderOptions layers{.layers = "direct,backscatter,irradiance,clean"};
    const ImageScene blurred = moving_scene(", samples: 256, shutter: 0.04", "", moves);
    const ImageScene sharp = blurred.with([](SceneDesc& desc) {
        desc.render.shutter = 0;
        desc.render.samples = 16;
    });
    const std::vector<double> truth = mean_over_instants(sharp, 64, layers);
    Renderer renderer;
    renderer.set_scene(blurred);
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

}  // namespace
}  // namespace uw::test
