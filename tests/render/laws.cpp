// ctest labels: metamorphic threads
#include <gtest/gtest.h>

#include "core/image/layers.h"
#include "tests/support/image_laws.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

SceneDesc lit_box() {
    SceneDesc desc = pinhole_scene(24, 18);
    desc.geometry = {plane_at_z(4), box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3})};
    desc.lamps = {isotropic_lamp({1, -0.5, 0}, 50)};
    desc.render.samples = 4;
    return desc;
}

TEST(RenderLaws, ImagesAreTheSameForThreadsAndWindowsAndAddUp) {
    const Film film =
        expect_same_for_threads_and_windows(lit_box(), {.layers = "all,lamps"}, {5, 3, 20, 17});
    EXPECT_GT(expect_components_add_up(film), 0);
}

TEST(RenderLaws, TwiceTheLampIsTwiceTheImage) {
    SceneDesc bright = lit_box();
    bright.lamps = {isotropic_lamp({1, -0.5, 0}, 100)};
    const RenderOptions all{.layers = "all"};
    const Film dim = image_of(lit_box(), all), twice = image_of(bright, all);
    const auto is_light_of_lamps = [&](const std::string& name) {
        return name != "A" &&
               (is_light(name) || name.starts_with("irradiance.") || name.starts_with("exitance."));
    };
    for (int y = 0; y < dim.height(); ++y)
        for (int x = 0; x < dim.width(); ++x)
            for (std::size_t c = 0; c < dim.channel_names().size(); ++c)
                // A power of two changes only exponents: the images are equal to the bit.
                EXPECT_EQ(twice.pixel(x, y)[c],
                          (is_light_of_lamps(dim.channel_names()[c]) ? 2 : 1) * dim.pixel(x, y)[c])
                    << dim.channel_names()[c];
}

TEST(RenderLaws, LampsAddUpToTheTotal) {
    SceneDesc desc = lit_box();
    desc.lamps.push_back(isotropic_lamp({-0.8, 0.1, 0.2}, 20));
    desc.lamps.back().name = "second";
    const TestScene scene(desc);
    for (const PixelResult& pixel : scene.image()) {
        for (std::size_t band = 0; band < 3; ++band) {
            const double total = pixel.direct[band] + pixel.backscatter[band];
            EXPECT_NEAR(pixel.lamps[0][band] + pixel.lamps[1][band], total, 1e-12 * total);
        }
    }
}

TEST(RenderLaws, WallHidesTheLampBehindIt) {
    SceneDesc desc = lit_box();
    desc.lamps = {isotropic_lamp({0.4, -0.3, 5}, 50)};  // behind the plane z = 4
    for (const PixelResult& pixel : TestScene(desc).image()) {
        EXPECT_EQ(pixel.direct[0], 0);
        EXPECT_EQ(pixel.backscatter[0], 0);
        EXPECT_EQ(pixel.lit, 0);
    }
}

TEST(RenderLaws, CleanLayerIsTheSurfaceWithoutWater) {
    SceneDesc water = lit_box();
    SceneDesc clear = lit_box();
    clear.water.absorption = PerBand{0, 0, 0};
    clear.water.scattering->b = {0, 0, 0};
    const std::vector<PixelResult> in_water = TestScene(water).image();
    const std::vector<PixelResult> in_vacuum = TestScene(clear).image();
    for (std::size_t i = 0; i < in_water.size(); ++i) {
        for (std::size_t band = 0; band < 3; ++band) {
            EXPECT_NEAR(in_water[i].clean[band], in_vacuum[i].direct[band],
                        1e-12 * in_water[i].clean[band]);
            EXPECT_EQ(in_vacuum[i].backscatter[band], 0);
        }
    }
}

}  // namespace
}  // namespace uw::test
