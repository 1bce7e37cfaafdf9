// ctest labels: statistical metamorphic
// Images of thick marine snow as a whole (docs/snow.md).
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "tests/support/image_laws.h"
#include "tests/support/message_of.h"
#include "tests/support/snow/thick_snow.h"

namespace uw::test {
namespace {

TEST(SnowImages, TheMeanOverSeedsIsThatOfTheCoefficients) {
    SceneDesc without = thick_scene();
    without.water.snow.reset();
    expect_mean(thick_scene(), without);
}

TEST(SnowImages, ComponentsAddUpAlsoWhereForwardScatterBlursThem) {
    SceneDesc desc = thick_scene();
    const RenderOptions layers{.layers = "direct,forward,backscatter,snow"};
    const Film still = image_of(desc, layers);
    EXPECT_GT(expect_components_add_up(still), 0);
    desc.water.forward_scatter = {.K = 1, .G = 0.02, .B = 0.02};
    const Film blurred = image_of(desc, layers);
    EXPECT_GT(expect_components_add_up(blurred), 0);
    const auto snow = std::ranges::find(still.channel_names(), "snow.R");
    ASSERT_NE(snow, still.channel_names().end());
    const auto channel = static_cast<std::size_t>(snow - still.channel_names().begin());
    for (int y = 0; y < still.height(); ++y)
        for (int x = 0; x < still.width(); ++x)
            ASSERT_EQ(blurred.pixel(x, y)[channel], still.pixel(x, y)[channel]);
}

TEST(SnowImages, ThreadsAndCropsChangeNothing) {
    SceneDesc desc = thick_scene();
    desc.camera.width = 90;
    desc.camera.height = 70;
    desc.render.shutter = 0.05;
    desc.water.snow->drift = {0.3, 0.1, -0.2};
    desc.camera.lens = LensDesc{2.8, 0.02, 1, 1.2};
    expect_same_for_threads_and_windows(desc, {.layers = "total,snow"}, {37, 21, 71, 50});
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
