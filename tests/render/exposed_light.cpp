// ctest labels: unit analytic
//
// Light that was scattered more than once is traced at a few moments of an exposure, which many of
// its parts share.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/motion/moving_scene.h"

namespace uw::test {
namespace {

constexpr int k_exposed_width = 80, k_exposed_height = 72;
const RenderOptions k_scattered_layers{.layers = "multiple.volume,multiple.surface"};

ImageScene exposed_scene(int samples) {
    return moving_scene(", shutter: 0.04, scattering: multiple, samples: " +
                        std::to_string(samples))
        .with([](SceneDesc& desc) {
            desc.render.quality = RenderDesc::Quality::draft;
            resize_image(desc.camera, k_exposed_width, k_exposed_height);
        });
}

/// Sums over the channels of squares of the image, by square: what noise and edges leave alike.
std::vector<double> squares_of(const std::vector<double>& values, std::size_t stride,
                               std::size_t first, std::size_t count) {
    constexpr int k_side = 8;
    std::vector<double> sums(
        static_cast<std::size_t>(k_exposed_width / k_side * (k_exposed_height / k_side)));
    for (int y = 0; y < k_exposed_height; ++y)
        for (int x = 0; x < k_exposed_width; ++x)
            for (std::size_t k = 0; k < count; ++k)
                sums[static_cast<std::size_t>(y / k_side * (k_exposed_width / k_side) +
                                              x / k_side)] +=
                    values[static_cast<std::size_t>(y * k_exposed_width + x) * stride + first + k];
    return sums;
}

// The RMS of the relative differences of all squares.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
    double squares = 0;
    for (std::size_t i = 0; i < a.size(); ++i) squares += std::pow(a[i] / b[i] - 1, 2);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

/// Keeps the water's tables from one image to the next.
Renderer& renderer() {
    static Renderer renderer;
    return renderer;
}

/// The film is valid until the next image.
const Film& render(const ImageScene& scene, const RenderOptions& options = k_scattered_layers) {
    renderer().set_scene(scene);
    return renderer().render(options);
}

ImageScene without_shutter(const ImageScene& scene) {
    return scene.with([](SceneDesc& desc) { desc.render.shutter = 0; });
}

TEST(ExposedLight, IsTheMeanOverInstants) {
    constexpr int k_instants = 5;
    std::vector<double> truth;
    for (int i = 0; i < k_instants; ++i) {
        const ImageScene scene = exposed_scene(4);
        const double time = *scene.time() + k_shutter * ((i + 0.5) / k_instants - 0.5);
        const Film& film = render(without_shutter(scene.at(time)));
        truth.resize(film.values().size());
        for (std::size_t k = 0; k < truth.size(); ++k)
            truth[k] += static_cast<double>(film.values()[k]) / k_instants;
    }
    const Film& film = render(exposed_scene(16));
    const std::size_t stride = film.channel_names().size();
    const std::vector<double> exposed = values_of(film);
    EXPECT_GT(renderer().report().exposure_parts, 8U);
    const std::vector<double> still = values_of(render(without_shutter(exposed_scene(4))));
    // Total, A, multiple.volume, multiple.surface. Draft noise of 5 %, which the moments have
    // mostly in common with the instants, and edges of surfaces, a fifth of their motion apart.
    const auto error_of_light = [&](const std::vector<double>& values, std::size_t first) {
        return difference(squares_of(values, stride, first, 3),
                          squares_of(truth, stride, first, 3));
    };
    EXPECT_LT(error_of_light(exposed, 4), 0.006) << "twice if there were one moment alone";
    EXPECT_LT(error_of_light(exposed, 7), 0.02);
    EXPECT_GT(error_of_light(still, 7), 3 * error_of_light(exposed, 7)) << "no small motion";
}

TEST(ExposedLight, IsTheSameInCrops) {
    const ImageScene scene = exposed_scene(4);
    const PixelWindow window{30, 28, 50, 40};
    const std::vector<double> whole = values_of(render(scene));
    RenderOptions options = k_scattered_layers;
    options.window = window;
    const Film& crop = render(scene, options);
    const std::size_t stride = crop.channel_names().size();
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            for (std::size_t k = 0; k < stride; ++k)
                EXPECT_EQ(static_cast<double>(crop.pixel(x, y)[k]),
                          whole[static_cast<std::size_t>(y * k_exposed_width + x) * stride + k]);
}

}  // namespace
}  // namespace uw::test
