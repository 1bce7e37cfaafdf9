// ctest labels: statistical metamorphic
// Images of thick marine snow as a whole (docs/snow.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "tests/support/message_of.h"
#include "tests/support/snow/snow_scene.h"

namespace uw::test {
namespace {

/// A thick snow that the coefficients hold: nearly half of what they scatter at right angles, a
/// third of what they take away.
SceneDesc thick_scene() {
    SceneDesc desc = pinhole_scene(40, 30);
    desc.water = hg_water(0);
    SnowDesc snow;
    snow.number = 3e5;
    snow.least = 4e-4;
    snow.greatest = 4e-3;
    snow.exponent = 4;
    snow.reflectance = {0.7, 0.6, 0.5};
    desc.water.snow = snow;
    desc.geometry = {plane_at_z(2.5)};
    desc.lamps = {isotropic_lamp({0.4, -0.3, 0.1}, 40)};
    return desc;
}

double mean_of(const Film& film, std::size_t channel) {
    double sum = 0;
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x)
            sum += static_cast<double>(film.pixel(x, y)[channel]);
    return sum / (film.width() * film.height());
}

/// The mean over seeds is the image of the same coefficients without particles: within four
/// standard errors, and half a per cent for what single particles hide of the water's light, of
/// which the share behind them is interpolated over the image and the same for all bands.
void expect_mean(SceneDesc desc, const SceneDesc& without) {
    const Film smooth = image_of(without, {.layers = "total"});
    constexpr int k_seeds = 150;
    std::array<double, 3> sum{}, squares{};
    for (int seed = 0; seed < k_seeds; ++seed) {
        desc.water.snow->seed = static_cast<std::uint64_t>(seed);
        const Film film = image_of(desc, {.layers = "total"});
        for (std::size_t b = 0; b < 3; ++b) {
            const double value = mean_of(film, b) / mean_of(smooth, b);
            sum[b] += value;
            squares[b] += value * value;
        }
    }
    for (std::size_t b = 0; b < 3; ++b) {
        const double mean = sum[b] / k_seeds;
        const double error = std::sqrt((squares[b] / k_seeds - mean * mean) / (k_seeds - 1));
        EXPECT_LT(error, 5e-3) << "too few seeds to tell";
        EXPECT_NEAR(mean, 1, 4 * error + 5e-3) << "band " << b << ", error " << error;
    }
}

TEST(SnowImages, TheMeanOverSeedsIsThatOfTheCoefficients) {
    SceneDesc without = thick_scene();
    without.water.snow.reset();
    expect_mean(thick_scene(), without);
}

/// Few particles are drawn; the others are their mean.
TEST(SnowImages, ParticlesNotDrawnAreTheirMean) {
    SceneDesc desc = thick_scene(), without = desc;
    desc.water.snow->most = 300;
    without.water.snow.reset();
    expect_mean(desc, without);
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
