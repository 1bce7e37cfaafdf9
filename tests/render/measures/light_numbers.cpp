// ctest labels: unit analytic metamorphic
#include "render/measures/picture_numbers.h"

#include <gtest/gtest.h>

#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr double k_bands_nm[] = {620, 540, 450};

LayerPlan plan_of(std::string_view layers) {
    return {layers, k_bands_nm, std::vector<std::string>{}};
}

/// 10 x 10 pixels whose direct light is 1 to 100 in the red band and 0 in the others.
Film ramp(const LayerPlan& plan) {
    Film film(10, 10, {0, 0, 10, 10}, plan.channel_names());
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 10; ++x) {
            plan.channels(Layer::direct, film.pixel(x, y))[0] = static_cast<float>(10 * y + x + 1);
            plan.channels(Layer::backscatter, film.pixel(x, y))[2] = 6;
        }
    return film;
}

TEST(LightNumbers, AreMeansAndPercentilesOfTheMeanOfBands) {
    const LayerPlan plan = plan_of(k_picture_layers);
    const Film film = ramp(plan);
    const LightNumbers all = light_numbers({film, plan}, pixels_within({0, 0, 10, 10}, 10));
    EXPECT_EQ(all.pixels, 100U);
    EXPECT_DOUBLE_EQ(all.direct.mean, 50.5 / 3);
    // Between the values at places 0.05 * 99 and so on, from 0.
    EXPECT_DOUBLE_EQ(all.direct.percentile5, (1 + 0.05 * 99) / 3);
    EXPECT_DOUBLE_EQ(all.direct.median, 50.5 / 3);
    EXPECT_DOUBLE_EQ(all.direct.percentile95, (1 + 0.95 * 99) / 3);
    EXPECT_DOUBLE_EQ(all.backscatter.mean, 2);
    EXPECT_DOUBLE_EQ(all.backscatter.percentile5, 2);
    EXPECT_DOUBLE_EQ(all.forward.mean, 0);
    EXPECT_FALSE(all.multiple);
    EXPECT_DOUBLE_EQ(all.picture.signal_to_backscatter, 50.5 / 3 / 2);
    const LightNumbers row = light_numbers({film, plan}, pixels_within({0, 1, 10, 2}, 10));
    EXPECT_DOUBLE_EQ(row.direct.mean, 15.5 / 3);
}

TEST(LightNumbers, LeaveOutWhatIsEmitted) {
    const LayerPlan plan = plan_of(k_picture_layers);
    const Film film = ramp(plan);
    const LightNumbers none = light_numbers({film, plan, &film}, pixels_within({0, 0, 10, 10}, 10));
    EXPECT_DOUBLE_EQ(none.direct.percentile95, 0);
    EXPECT_DOUBLE_EQ(none.backscatter.mean, 0);
    EXPECT_DOUBLE_EQ(none.picture.signal, 0);
}

TEST(LampNumbers, AddUpToThoseOfAllLight) {
    SceneDesc desc = pinhole_scene(32, 18);
    desc.water = hg_water(0.8);
    desc.geometry = {plane_at_z(3)};
    desc.lamps = {isotropic_lamp({-0.5, 0, 0}, 10), isotropic_lamp({0.4, 0.3, 0.5}, 5)};
    desc.lamps[0].name = "a";
    desc.lamps[1].name = "b";
    const ImageScene scene(std::move(desc));
    Renderer renderer;
    renderer.set_scene(scene);
    const std::string layers = layers_to_measure(scene);
    const LayerPlan plan = layer_plan(scene, layers);
    const Film film = [&] {
        renderer.render({.layers = layers});
        return renderer.release_film();
    }();
    const std::vector<PicturePart> parts{
        {"image", pixels_within({0, 0, film.width(), film.height()}, film.width())},
        {"corner", pixels_within({0, 0, 8, 6}, film.width())}};
    const std::vector<PartNumbers> all = part_numbers({film, plan}, parts);
    const std::vector<PartNumbers> lamps = lamp_numbers(renderer, scene, {}, parts);
    ASSERT_EQ(all.size(), 2U);
    ASSERT_EQ(lamps.size(), 2 * scene.desc().lamps.size());
    ASSERT_GT(scene.desc().lamps.size(), 1U);
    for (std::size_t part = 0; part < 2; ++part) {
        double direct = 0, backscatter = 0, irradiance = 0;
        for (std::size_t i = part; i < lamps.size(); i += 2) {
            EXPECT_EQ(lamps[i].part, all[part].part);
            EXPECT_EQ(lamps[i].lamp, scene.desc().lamps[i / 2].name);
            direct += lamps[i].numbers.direct.mean;
            backscatter += lamps[i].numbers.backscatter.mean;
            irradiance += lamps[i].numbers.picture.evenness->mean *
                          static_cast<double>(lamps[i].numbers.picture.evenness->pixels);
        }
        // Films hold 32-bit floats; in-scatter is interpolated to 0.2 %, lamp by lamp.
        EXPECT_NEAR(direct, all[part].numbers.direct.mean, 1e-5 * direct);
        EXPECT_NEAR(backscatter, all[part].numbers.backscatter.mean, 2e-3 * backscatter);
        const Evenness& even = *all[part].numbers.picture.evenness;
        EXPECT_NEAR(irradiance, even.mean * static_cast<double>(even.pixels), 1e-5 * irradiance);
    }
}

}  // namespace
}  // namespace uw::test
