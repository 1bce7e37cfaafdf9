// ctest labels: unit analytic
#include "render/measures/picture_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "render/renderer.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

constexpr std::size_t k_bands = 3;

/// A layer with the same value in all bands.
class Plane {
  public:
    template <class Value>
    Plane(int width, int height, const Value& value) {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                values_.insert(values_.end(), k_bands, static_cast<float>(value(x, y)));
    }
    PicturePlane plane(double gain = 1) const {
        return {values_, k_bands, per_band(k_bands, [gain](std::size_t) { return gain; })};
    }

  private:
    std::vector<float> values_;
};

Plane even(double value) {
    return {20, 10, [value](int, int) { return value; }};
}

PictureLayers picture() {
    PictureLayers layers;
    layers.width = 20;
    layers.height = 10;
    layers.bands = k_bands;
    return layers;
}

constexpr PixelWindow k_all{0, 0, 20, 10};

TEST(PictureNumbers, AreThoseOfEvenLayers) {
    const Plane direct = even(3), forward = even(1), backscatter = even(2), clean = even(16),
                light = even(5);
    PictureLayers layers = picture();
    layers.signal = {direct.plane(), forward.plane()};
    layers.backscatter = {backscatter.plane()};
    layers.clean = {clean.plane()};
    layers.irradiance = {light.plane()};
    const PictureNumbers numbers = measure_picture(layers, k_all);
    EXPECT_DOUBLE_EQ(numbers.signal, 4);
    EXPECT_DOUBLE_EQ(numbers.backscatter, 2);
    EXPECT_DOUBLE_EQ(numbers.signal_to_backscatter, 2);
    EXPECT_EQ(numbers.contrast, 0);
    EXPECT_DOUBLE_EQ(numbers.lost_to_water.value(), 0.75);
    EXPECT_EQ(numbers.evenness->pixels, 200U);
    EXPECT_DOUBLE_EQ(numbers.evenness->min_to_mean, 1);
    EXPECT_EQ(measure_picture(layers, k_all, 2).fraction_above, 1);
    EXPECT_EQ(measure_picture(layers, k_all, 2.001).fraction_above, 0);
}

TEST(PictureNumbers, OfLampsAreMixedByTheirGains) {
    const Plane left = even(3), right = even(1), water = even(2);
    PictureLayers layers = picture();
    layers.signal = {left.plane(2), right.plane(0)};
    layers.backscatter = {water.plane(0.25), water.plane(0.75)};
    const PictureNumbers numbers = measure_picture(layers, k_all);
    EXPECT_DOUBLE_EQ(numbers.signal, 6);
    EXPECT_DOUBLE_EQ(numbers.backscatter, 2);
    EXPECT_FALSE(numbers.lost_to_water || numbers.clean_contrast || numbers.evenness);
    layers.backscatter = {water.plane(0)};
    EXPECT_EQ(measure_picture(layers, k_all).signal_to_backscatter,
              std::numeric_limits<double>::infinity());
    layers.signal = {left.plane(0)};
    EXPECT_EQ(measure_picture(layers, k_all).signal_to_backscatter, 0);
    EXPECT_EQ(measure_picture(layers, k_all).contrast, 0);
}

// Squares of 6 and 2 under a veil of 1, with a dead and a bright pixel and a blurred edge: the
// contrast is that of the squares, (7 - 3) / (7 + 3).
TEST(PictureNumbers, HaveTheContrastOfASquarePattern) {
    const Plane squares(20, 10, [](int x, int y) {
        if (x == 0 && y == 0) return 1000.0;
        if (x == 7 && y == 3) return 0.0;
        if (x % 5 == 0) return 4.0;
        return (x / 5 + y / 5) % 2 == 0 ? 6.0 : 2.0;
    });
    const Plane veil = even(1);
    PictureLayers layers = picture();
    layers.signal = {squares.plane()};
    layers.backscatter = {veil.plane()};
    layers.clean = {squares.plane()};
    EXPECT_DOUBLE_EQ(measure_picture(layers, k_all).contrast, 0.4);
    EXPECT_DOUBLE_EQ(measure_picture(layers, k_all).clean_contrast.value(), 0.5);
    EXPECT_EQ(measure_picture(layers, {1, 0, 5, 5}).contrast, 0) << "one square";
}

// A board of 0.6 and 0.2, lit ten times as brightly on its right: the contrast is the albedos'.
TEST(PictureNumbers, HaveAContrastThatUnevenLightDoesNotRaise) {
    const auto reflects = [](int x, int y) { return (x / 4 + y / 4) % 2 == 0 ? 0.6 : 0.2; };
    const Plane albedo(20, 10, reflects);
    const Plane light(20, 10, [&](int x, int y) { return (x < 10 ? 1 : 10) * reflects(x, y); });
    PictureLayers layers = picture();
    layers.signal = {light.plane()};
    layers.clean = {light.plane()};
    EXPECT_GT(measure_picture(layers, k_all).contrast, 0.8);
    layers.albedo = {albedo.plane()};
    // The step of the light, at x = 10, lies in a tile of its own: 8 to 16.
    EXPECT_NEAR(measure_picture(layers, k_all).contrast, 0.5, 0.06);
    EXPECT_NEAR(measure_picture(layers, {0, 0, 8, 10}).contrast, 0.5, 1e-6);
    EXPECT_NEAR(measure_picture(layers, {0, 0, 8, 10}).clean_contrast.value(), 0.5, 1e-6);
    const Plane plain = even(0.4);
    layers.albedo = {plain.plane()};
    EXPECT_GT(measure_picture(layers, k_all).contrast, 0.8) << "no pattern";
}

TEST(PictureNumbers, CountTheFractionOfPixelsAboveARatio) {
    const Plane signal(20, 10, [](int x, int) { return x; });
    const Plane veil = even(2);
    PictureLayers layers = picture();
    layers.signal = {signal.plane()};
    layers.backscatter = {veil.plane()};
    EXPECT_DOUBLE_EQ(measure_picture(layers, k_all, 2.5).fraction_above, 15.0 / 20) << "x >= 5";
    EXPECT_DOUBLE_EQ(measure_picture(layers, {10, 0, 20, 10}, 2.5).fraction_above, 1);
    EXPECT_DOUBLE_EQ(measure_picture(layers, k_all, 0).fraction_above, 19.0 / 20)
        << "without signal nothing is seen";
}

// 1 .. 20 on the columns, 0 where there is no surface.
TEST(PictureNumbers, TellHowEvenlySurfacesAreLit) {
    const Plane light(20, 10, [](int x, int y) { return y < 5 ? x + 1 : 0; });
    const Plane albedo(20, 10, [](int, int y) { return y < 6 ? 0.5 : 0; });
    PictureLayers layers = picture();
    layers.irradiance = {light.plane()};
    const Evenness lit = measure_picture(layers, k_all).evenness.value();
    EXPECT_EQ(lit.pixels, 100U);
    EXPECT_DOUBLE_EQ(lit.mean, 10.5);
    EXPECT_EQ(lit.least, 1);
    EXPECT_EQ(lit.greatest, 20);
    EXPECT_DOUBLE_EQ(lit.median, 10.5);
    EXPECT_DOUBLE_EQ(lit.percentile5, 1.95);  // at 4.95 of 0 .. 99, between a 1 and a 2
    EXPECT_DOUBLE_EQ(lit.percentile95, 19.05);
    EXPECT_DOUBLE_EQ(lit.min_to_mean, 1 / 10.5);
    layers.albedo = {albedo.plane()};
    const Evenness all = measure_picture(layers, k_all).evenness.value();
    EXPECT_EQ(all.pixels, 120U) << "with the row in the dark";
    EXPECT_EQ(all.least, 0);
    EXPECT_DOUBLE_EQ(all.mean, 8.75);
}

TEST(PatternedPart, IsWhereTheCheckerboardIs) {
    const auto on_board = [](int x, int y) { return x >= 40 && x < 60 && y >= 12 && y < 32; };
    const Plane albedo(80, 50, [&](int x, int y) {
        if (!on_board(x, y)) return 0.3 + 0.001 * x;
        return ((x - 40) / 5 + (y - 12) / 5) % 2 == 0 ? 0.9 : 0.05;
    });
    PictureLayers layers;
    layers.width = 80;
    layers.height = 50;
    layers.bands = k_bands;
    EXPECT_FALSE(patterned_part(layers, 10));
    layers.albedo = {albedo.plane()};
    const PixelWindow part = patterned_part(layers, 10).value();
    EXPECT_EQ(part.width(), 10);
    EXPECT_EQ(part.height(), 10);
    EXPECT_TRUE(on_board(part.x0, part.y0) && on_board(part.x1 - 1, part.y1 - 1));
    const Plane plain(80, 50, [](int, int) { return 0.37; });
    layers.albedo = {plain.plane()};
    EXPECT_FALSE(patterned_part(layers, 10));
    EXPECT_FALSE(patterned_part(layers, 51)) << "larger than the picture";
}

// A wall, a lamp beside the camera: of the light that crosses R + s metres of water from the lamp
// to the wall and on to the camera, e^(-c (R + s)) is left.
TEST(PictureNumbers, OfARenderedImageAreThoseOfItsGeometry) {
    SceneDesc desc = pinhole_scene(31, 21);
    desc.geometry = {plane_at_z(2)};
    desc.lamps = {isotropic_lamp({0.5, 0, 0}, 40)};
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc));
    const Film& film = renderer.render({.layers = k_picture_layers});
    const LayerPlan plan = layer_plan(renderer.scene(), k_picture_layers);
    const PictureLayers layers = picture_layers(film, plan);
    const PictureNumbers middle = measure_picture(layers, {15, 10, 16, 11});
    double with_water = 0, without = 0, irradiance = 0;
    for (std::size_t b = 0; b < k_bands; ++b) {
        const double c = desc.water.absorption->at(b) + desc.water.scattering->b[b];
        const double r = std::hypot(0.5, 2.0);
        const double light = 40 / (r * r) * (2 / r);
        without += 0.5 * light / M_PI / k_bands;
        with_water += 0.5 * light / M_PI * std::exp(-c * (r + 2)) / k_bands;
        irradiance += light * std::exp(-c * r) / k_bands;
    }
    // Rounded to float; the optical depths are the formula's own.
    EXPECT_NEAR(middle.signal, with_water, 1e-6 * with_water);
    EXPECT_NEAR(middle.lost_to_water.value(), 1 - with_water / without, 1e-6);
    EXPECT_NEAR(middle.evenness->mean, irradiance, 1e-6 * irradiance);
    const PictureNumbers whole = measure_picture(layers, {0, 0, 31, 21});
    EXPECT_EQ(whole.evenness->pixels, 31U * 21U);
    EXPECT_GT(whole.backscatter, 0);
    EXPECT_GT(whole.evenness->greatest, irradiance);
    EXPECT_LT(whole.evenness->least, irradiance);
}

}  // namespace
}  // namespace uw::test
