// ctest labels: unit
#include "core/image/pixel_image.h"
#include "core/image/preview_exposure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace uw {
namespace {

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// A row of grey pixels with alpha 1.
Film grey_row(const std::vector<float>& values) {
    const int width = static_cast<int>(values.size());
    Film film(width, 1, {0, 0, width, 1}, {"R", "G", "B", "A"});
    for (int x = 0; x < width; ++x) {
        const auto pixel = film.pixel(x, 0);
        for (std::size_t c = 0; c < 3; ++c) pixel[c] = values[static_cast<std::size_t>(x)];
        pixel[k_alpha] = 1;
    }
    return film;
}

TEST(Preview, ExposureBringsThe99thPercentileTo80Percent) {
    std::vector<float> values;
    for (int i = 0; i <= 100; ++i) values.push_back(static_cast<float>(0.001 * i));
    const auto exposure = automatic_exposure(grey_row(values));
    ASSERT_TRUE(exposure);
    EXPECT_NEAR(*exposure, 0.8 / 0.099, 1e-5);  // float values
    // One hot pixel in a hundred does not darken the picture.
    values.back() = 1e6f;
    EXPECT_NEAR(*automatic_exposure(grey_row(values)), 0.8 / 0.099, 1e-5);
}

TEST(Preview, ExposureIgnoresPixelsWithoutRayOrValue) {
    Film film = grey_row({0.5f, 0.5f, 9.0f, k_nan, k_infinity});
    film.pixel(2, 0)[k_alpha] = 0;
    const auto exposure = automatic_exposure(film);
    ASSERT_TRUE(exposure);
    EXPECT_NEAR(*exposure, 1.6, 1e-6);
}

TEST(Preview, LampsInViewDoNotDarkenThePicture) {
    Film film = grey_row({0.5f, 0.5f, 0.5f, 900.0f, 900.0f});
    film.mark_lamp(3, 0);
    film.mark_lamp(4, 0);
    EXPECT_NEAR(automatic_exposure(film).value_or(0), 1.6, 1e-6);
    const Film part = cropped(film, {2, 0, 4, 1});
    EXPECT_NEAR(automatic_exposure(part).value_or(0), 1.6, 1e-6);
    // Where nothing else is seen, they are what the picture is of.
    EXPECT_NEAR(automatic_exposure(cropped(film, {3, 0, 5, 1})).value_or(0), 0.8 / 900, 1e-9);
    film.clear();
    EXPECT_FALSE(film.shows_lamp(3, 0));
}

TEST(Preview, AFewBrightPixelsInTheDarkAreShown) {
    std::vector<float> values(1000, 0.0f);
    values[17] = 0.25f;
    EXPECT_NEAR(automatic_exposure(grey_row(values)).value_or(0), 3.2, 1e-6);
}

TEST(Preview, BlackImagesSaySo) {
    EXPECT_FALSE(automatic_exposure(grey_row({0, 0, 0})));
    EXPECT_FALSE(automatic_exposure(grey_row({k_nan, -1})));
    Film no_rays = grey_row({1});
    no_rays.pixel(0, 0)[k_alpha] = 0;
    EXPECT_FALSE(automatic_exposure(no_rays));
}

TEST(Preview, EncodesAsSrgb) {
    Film film(6, 3, {1, 1, 5, 2}, {"R", "G", "B", "A"});
    for (int x = 1; x < 5; ++x) film.pixel(x, 1)[k_alpha] = 1;
    const auto first = film.pixel(1, 1);
    first[k_red] = 0.107f;  // twice that is 0.214: mid grey, 127.5 of 255
    first[k_green] = 5;
    first[k_blue] = -1;
    film.pixel(2, 1)[k_red] = k_nan;
    film.pixel(3, 1)[k_red] = 1;
    film.pixel(3, 1)[k_alpha] = 0;
    film.pixel(4, 1)[k_green] = k_infinity;
    const Preview preview = make_preview(film, 2);
    ASSERT_EQ(preview.width(), 4);
    ASSERT_EQ(preview.height(), 1);
    EXPECT_EQ(preview(0, 0), (Srgb8{127, 255, 0}));
    EXPECT_EQ(preview(1, 0), (Srgb8{0, 0, 0}));
    EXPECT_EQ(preview(2, 0), (Srgb8{0, 0, 0}));
    EXPECT_EQ(preview(3, 0), (Srgb8{0, 255, 0}));
}

}  // namespace
}  // namespace uw
