// ctest labels: unit
// What each layer's channels hold of a pixel.
#include "core/passes/pixel_layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include <string>

#include "core/image/film.h"

namespace uw::test {
namespace {

const std::vector<double> k_bands{620, 540, 450};

/// A pixel whose every value is its own.
PixelResult full_pixel() {
    PixelResult pixel;
    pixel.alpha = 0.75;
    pixel.pixel_factor = 0.5;
    pixel.direct = {{1, 2, 3}};
    pixel.backscatter = {{10, 20, 30}};
    pixel.backscatter_first = {{5, 6, 7}};
    pixel.irradiance = {{11, 12, 13}};
    pixel.exitance = {{14, 15, 16}};
    pixel.clean = {{17, 18, 19}};
    pixel.transmittance = {{0.1, 0.2, 0.3}};
    pixel.lit = 0.25;
    pixel.lamps = {{{100, 200, 300}}};
    pixel.has_hit = true;
    pixel.hit.reflectance = {{0.4, 0.5, 0.6}};
    pixel.hit.normal = {0, -1, 0};
    pixel.hit.position = {7, 8, 9};
    pixel.hit.object_id = 42;
    pixel.depth_z = 2;
    pixel.range = 3;
    pixel.path = 4;
    return pixel;
}

class PixelLayers : public ::testing::Test {
  protected:
    using Values = std::vector<float>;

    void store(const PixelResult& pixel) { store_pixel(pixel, plan_, colour_, channels_); }
    Values of(Layer layer) {
        const std::span<float> own = plan_.channels(layer, channels_);
        return {own.begin(), own.end()};
    }

    std::vector<std::string> lamps_{"left"};
    LayerPlan plan_{"all", k_bands, lamps_};
    BandColour colour_{k_bands};
    std::vector<float> channels_ = std::vector<float>(plan_.channel_names().size(), -1.0F);
};

TEST_F(PixelLayers, RadianceHasThePixelsFactorAndTheRestHasNot) {
    store(full_pixel());
    EXPECT_EQ(channels_[k_red], 5.5F);  // three bands are R, G and B
    EXPECT_EQ(channels_[k_green], 11);
    EXPECT_EQ(channels_[k_alpha], 0.75F);
    EXPECT_EQ(of(Layer::direct), (Values{0.5, 1, 1.5}));
    EXPECT_EQ(of(Layer::forward), (Values{0, 0, 0}));
    EXPECT_EQ(of(Layer::backscatter), (Values{5, 10, 15}));
    EXPECT_EQ(of(Layer::backscatter_first), (Values{2.5, 3, 3.5}));
    EXPECT_EQ(of(Layer::clean), (Values{8.5, 9, 9.5}));
    EXPECT_EQ(of(Layer::irradiance), (Values{11, 12, 13}));
    EXPECT_EQ(of(Layer::exitance), (Values{14, 15, 16}));
    EXPECT_EQ(of(Layer::transmittance), (Values{0.1F, 0.2F, 0.3F}));
    EXPECT_EQ(of(Layer::lit), (Values{0.25}));
    const std::span<float> lamp = plan_.lamp_channels(0, channels_);
    EXPECT_EQ(Values(lamp.begin(), lamp.end()), (Values{50, 100, 150}));
}

// 0.1 + 0.2 in single precision is more than their sum rounded, which is what snow hides.
TEST_F(PixelLayers, TheTotalIsNotBelowZeroWhereSnowHidesAllOfIt) {
    PixelResult pixel = full_pixel();
    pixel.pixel_factor = 1;
    for (std::size_t b = 0; b < k_bands.size(); ++b) {
        pixel.direct[b] = 0.1 * static_cast<double>(b + 1);
        pixel.backscatter[b] = 0.7;
        pixel.snow[b] = -std::nextafter(static_cast<float>(pixel.direct[b]) + 0.7F, 1e9F);
    }
    store(pixel);
    for (const std::size_t channel : {k_red, k_green}) EXPECT_EQ(channels_[channel], 0);
    pixel.snow[0] = std::nan("");
    store(pixel);
    EXPECT_TRUE(std::isnan(channels_[k_red]));  // which is for others to find
}

TEST_F(PixelLayers, GroundTruthIsThatOfTheHit) {
    store(full_pixel());
    EXPECT_EQ(of(Layer::albedo), (Values{0.4F, 0.5F, 0.6F}));
    EXPECT_EQ(of(Layer::depth), (Values{2}));
    EXPECT_EQ(of(Layer::range), (Values{3}));
    EXPECT_EQ(of(Layer::path), (Values{4}));
    EXPECT_EQ(of(Layer::normal), (Values{0, -1, 0}));
    EXPECT_EQ(of(Layer::position), (Values{7, 8, 9}));
    EXPECT_EQ(of(Layer::id), (Values{42}));
}

// The channels were -1 before: whatever a pixel does not have is written as 0.
TEST_F(PixelLayers, WithoutAHitGroundTruthIsZero) {
    PixelResult pixel = full_pixel();
    pixel.has_hit = false;
    store(pixel);
    for (const Layer layer : {Layer::albedo, Layer::depth, Layer::range, Layer::path, Layer::normal,
                              Layer::position, Layer::id})
        for (const float value : of(layer)) EXPECT_EQ(value, 0);
    for (const float value : channels_) EXPECT_NE(value, -1);
}

TEST_F(PixelLayers, AResetPixelShowsNothing) {
    PixelResult pixel = full_pixel();
    pixel.reset(1);
    ASSERT_EQ(pixel.lamps.size(), 1U);
    store(pixel);
    for (const float value : channels_) EXPECT_EQ(value, 0);
}

TEST_F(PixelLayers, ForwardScatterChangesItsLayersAndLeavesTheOthers) {
    store(full_pixel());
    const Values irradiance = of(Layer::irradiance), depth = of(Layer::depth);
    PixelResult scattered;
    scattered.pixel_factor = 0.5;
    scattered.direct = {{1, 2, 3}};
    scattered.forward = {{4, 4, 4}};
    scattered.backscatter = {{12, 22, 32}};
    scattered.backscatter_first = {{1, 1, 1}};
    store_forward_scatter(scattered, plan_, colour_, channels_);
    EXPECT_EQ(channels_[k_red], 8.5F);
    EXPECT_EQ(of(Layer::forward), (Values{2, 2, 2}));
    EXPECT_EQ(of(Layer::backscatter), (Values{6, 11, 16}));
    EXPECT_EQ(of(Layer::backscatter_first), (Values{3, 3.5, 4}));
    EXPECT_EQ(of(Layer::irradiance), irradiance);
    EXPECT_EQ(of(Layer::depth), depth);
    add_forward_scatter_of_lamp(scattered, plan_, 0, channels_);
    EXPECT_EQ(plan_.lamp_channels(0, channels_)[0], 50 + 2 + 6);
}

/// Images of all light.
class PathLayers : public ::testing::Test {
  protected:
    /// A pixel whose light is `scale` thirds of what floats cannot hold exactly.
    static PixelResult pixel(double scale) {
        PixelResult result = full_pixel();
        result.pixel_factor = 0.7;
        result.direct = {{scale / 3, scale / 7, scale / 11}};
        result.backscatter = {{scale / 13, scale / 17, scale / 19}};
        result.multiple_volume = {{scale / 23, scale / 29, scale / 31}};
        result.multiple_surface = {{scale / 37, scale / 41, scale / 43}};
        result.lamps = {{{scale, scale, scale}}};
        result.orders.assign(3, Spectrum{{scale, scale, scale}});
        result.reflections.assign(3, Spectrum{{scale, scale, scale}});
        return result;
    }
    static std::vector<float> stored(const LayerPlan& plan) {
        return std::vector<float>(plan.channel_names().size(), -7.0F);
    }
    static void expect_sums(const LayerPlan& plan, std::vector<float>& channels) {
        for (std::size_t b = 0; b < 3; ++b) {
            const auto of = [&](Layer layer) { return plan.channels(layer, channels)[b]; };
            EXPECT_EQ(of(Layer::multiple),
                      of(Layer::multiple_volume) + of(Layer::multiple_surface));
            EXPECT_EQ(channels[b],
                      ((of(Layer::direct) + of(Layer::forward)) + of(Layer::backscatter)) +
                          of(Layer::multiple));
        }
    }

    std::vector<std::string> lamps_{"left"};
    BandColour colour_{k_bands};
    LayerSupply supply_{
        .layers = {Layer::multiple, Layer::multiple_volume, Layer::multiple_surface, Layer::error},
        .orders = 1};
};

TEST_F(PathLayers, AddUpToTheBitBeforeAndAfterMorePaths) {
    const LayerPlan plan("all", k_bands, lamps_, supply_);
    std::vector<float> channels = stored(plan);
    store_pixel(pixel(1), plan, colour_, channels);
    expect_sums(plan, channels);
    for (const float value : channels) EXPECT_NE(value, -7);
    for (int round = 1; round < 20; ++round) {
        merge_paths(pixel(1 + 0.1 * round), 1.0 / (round + 1), plan, colour_, channels);
        expect_sums(plan, channels);
    }
    // The mean of 1 to 2.9.
    EXPECT_NEAR(plan.channels(Layer::direct, channels)[0], 0.7 * 1.95 / 3, 1e-6);
    EXPECT_NEAR(plan.lamp_channels(0, channels)[1], 0.7 * 1.95, 1e-6);
    EXPECT_NEAR(plan.order_channels(2, channels)[2], 0.7 * 1.95, 1e-6);
    EXPECT_NEAR(plan.reflection_channels(0, channels)[2], 0.7 * 1.95, 1e-6);
}

TEST_F(PathLayers, OfMorePathsLeaveWhatIsNoMeanOverPaths) {
    const LayerPlan plan("all", k_bands, lamps_, supply_);
    std::vector<float> channels = stored(plan);
    store_pixel(pixel(1), plan, colour_, channels);
    PixelResult more;
    more.reset(1);
    more.alpha = 0.25;
    more.orders.assign(3, Spectrum{});
    more.reflections.assign(3, Spectrum{});
    merge_paths(more, 0.5, plan, colour_, channels);
    EXPECT_EQ(channels[k_alpha], 0.5F);
    EXPECT_EQ(plan.channels(Layer::depth, channels)[0], 2);
    EXPECT_EQ(plan.channels(Layer::irradiance, channels)[0], 11);
    EXPECT_EQ(plan.channels(Layer::clean, channels)[0], 0.7F * 17);
    EXPECT_FLOAT_EQ(plan.channels(Layer::direct, channels)[0], 0.5F * 0.7F / 3);
}

// The total is the same whatever else the image holds.
TEST_F(PathLayers, TotalDoesNotNeedItsTerms) {
    const std::vector<double> bands{450, 500, 550, 600};
    const BandColour colour(bands);
    const auto totals = [&](const char* layers) {
        const LayerPlan plan(layers, bands, lamps_, supply_);
        std::vector<float> channels = stored(plan);
        store_pixel(pixel(1), plan, colour, channels);
        merge_paths(pixel(3), 0.25, plan, colour, channels);
        const std::span<float> total = plan.channels(Layer::total, channels);
        std::vector<float> all(total.begin(), total.end());
        all.insert(all.end(), channels.begin(), channels.begin() + 4);
        return all;
    };
    const std::vector<float> whole = totals("all");
    for (const char* const layers : {"total", "total,direct,multiple", "total,multiple.volume"}) {
        const std::vector<float> other = totals(layers);
        for (std::size_t i = 0; i < whole.size(); ++i)
            EXPECT_NEAR(other[i], whole[i], 1e-6) << layers;
    }
}

TEST(InScatterPartsOfLayers, AreThoseThatSomeLayerNeeds) {
    const std::vector<std::string> lamps{"left", "right"};
    const auto parts = [&](const char* layers) {
        return in_scatter_parts(LayerPlan(layers, k_bands, lamps));
    };
    EXPECT_FALSE(parts("direct,backscatter").first_slab);
    EXPECT_FALSE(parts("direct,backscatter").lamps);
    EXPECT_TRUE(parts("backscatter_first").first_slab);
    EXPECT_TRUE(parts("lamp.right").lamps);
}

}  // namespace
}  // namespace uw::test
