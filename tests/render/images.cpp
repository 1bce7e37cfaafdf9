// ctest labels: statistical metamorphic
// Images of thick marine snow as a whole (docs/snow.md).
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "tests/support/message_of.h"
#include "tests/support/snow/thick_snow.h"

namespace uw::test {
namespace {

TEST(SnowImages, TheMeanOverSeedsIsThatOfTheCoefficients) {
    SceneDesc without = thick_scene();
    without.water.snow.reset();
    expect_mean(thick_scene(), without);
}

TEST(SnowImages, ComponentsAddUpToTheTotalToTheBit) {
    const Film film = image_of(thick_scene(), {.layers = "total,direct,forward,backscatter,snow"});
    const auto channel = [&](const std::string& name) {
        return static_cast<std::size_t>(std::ranges::find(film.channel_names(), name) -
                                        film.channel_names().begin());
    };
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const auto pixel = film.pixel(x, y);
            const float sum = pixel[channel("direct.G")] + pixel[channel("forward.G")] +
                              pixel[channel("backscatter.G")] + pixel[channel("snow.G")];
            ASSERT_EQ(sum, pixel[1]);
        }
}

/// As above, in the picture that forward scatter blurs.
TEST(SnowImages, IsAddedToImagesWithForwardScatter) {
    SceneDesc desc = thick_scene();
    const Film still = image_of(desc, {.layers = "snow"});
    desc.water.forward_scatter = {.K = 1, .G = 0.02, .B = 0.02};
    const Film film = image_of(desc, {.layers = "total,direct,forward,backscatter,snow"});
    ASSERT_EQ(film.channel_names().size(), 16U);
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const auto pixel = film.pixel(x, y);
            ASSERT_EQ(pixel[4] + pixel[7] + pixel[10] + pixel[13], pixel[0]);
            ASSERT_EQ(pixel[13], still.pixel(x, y)[4]);
        }
}

TEST(SnowImages, ThreadsAndCropsChangeNothing) {
    SceneDesc desc = thick_scene();
    desc.camera.width = 90;
    desc.camera.height = 70;
    desc.render.shutter = 0.05;
    desc.water.snow->drift = {0.3, 0.1, -0.2};
    desc.camera.lens = LensDesc{2.8, 0.02, 1, 1.2};
    const RenderOptions all{.layers = "total,snow"};
    const Film whole = image_of(desc, all);
    {
        const ThreadLimit one(1);
        const Film alone = image_of(desc, all);
        EXPECT_TRUE(std::ranges::equal(whole.values(), alone.values()));
    }
    const PixelWindow window{37, 21, 71, 50};
    const Film part = image_of(desc, {.layers = all.layers, .window = window});
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            ASSERT_TRUE(std::ranges::equal(part.pixel(x, y), whole.pixel(x, y)))
                << x << " " << y << ": " << part.pixel(x, y)[0] << " " << whole.pixel(x, y)[0]
                << ", " << part.pixel(x, y)[4] << " " << whole.pixel(x, y)[4];
}

TEST(SnowImages, RefusesWhatTheCoefficientsCannotHold) {
    SceneDesc desc = thick_scene();
    desc.water.snow->number *= 10;
    desc.water.snow->where = "test.yaml:3:5: water.snow";
    const std::string message = message_of<InputError>([&] { image_of(desc); });
    EXPECT_NE(message.find("test.yaml:3:5: water.snow: the particles scatter"), std::string::npos);
    EXPECT_NE(message.find("mean: added"), std::string::npos);
    desc.water.snow->mean = SnowDesc::Mean::added;
    EXPECT_NO_THROW(image_of(desc));
    desc.render.integrator = RenderDesc::Integrator::path;
    EXPECT_NE(message_of<InputError>([&] { image_of(desc); }).find("integrator path"),
              std::string::npos);
}

}  // namespace
}  // namespace uw::test
