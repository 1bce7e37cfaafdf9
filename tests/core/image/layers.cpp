// ctest labels: unit
#include "core/image/layers.h"

#include <gtest/gtest.h>

#include <set>

#include "core/base/error.h"

namespace uw {
namespace {

using Names = std::vector<std::string>;
const std::vector<double> k_rgb{620, 540, 450};
const Names k_lamps{"left", "right.top"};

template <typename Error>
std::string message_of(std::string_view request, const std::vector<double>& bands = k_rgb,
                       const Names& lamps = k_lamps) {
    try {
        const LayerPlan plan(request, bands, lamps);
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing thrown";
}

TEST(Layers, AllIsEveryLayer) {
    const LayerPlan plan("all", k_rgb, {});
    const Names truth{"R",
                      "G",
                      "B",
                      "A",
                      "direct.R",
                      "direct.G",
                      "direct.B",
                      "forward.R",
                      "forward.G",
                      "forward.B",
                      "backscatter.R",
                      "backscatter.G",
                      "backscatter.B",
                      "backscatter_first.R",
                      "backscatter_first.G",
                      "backscatter_first.B",
                      "irradiance.R",
                      "irradiance.G",
                      "irradiance.B",
                      "exitance.R",
                      "exitance.G",
                      "exitance.B",
                      "lit.V",
                      "clean.R",
                      "clean.G",
                      "clean.B",
                      "transmittance.R",
                      "transmittance.G",
                      "transmittance.B",
                      "albedo.R",
                      "albedo.G",
                      "albedo.B",
                      "depth.Z",
                      "range.V",
                      "path.V",
                      "normal.X",
                      "normal.Y",
                      "normal.Z",
                      "position.X",
                      "position.Y",
                      "position.Z",
                      "id.V",
                      "material.V"};
    EXPECT_EQ(plan.channel_names(), truth);
    EXPECT_EQ(plan.first_channel(Layer::total), -1);  // R G B
    EXPECT_EQ(plan.first_channel(Layer::direct), 4);
    EXPECT_EQ(plan.first_channel(Layer::position), 38);
}

TEST(Layers, DefaultIsTheImageWithItsDepth) {
    const Names rgb{"R", "G", "B", "A", "depth.Z"};
    EXPECT_EQ(LayerPlan("", k_rgb, k_lamps).channel_names(), rgb);
    EXPECT_EQ(LayerPlan("default", k_rgb, k_lamps).channel_names(), rgb);
    EXPECT_EQ(LayerPlan("default", k_rgb, k_lamps, {.layers = {Layer::multiple, Layer::error}})
                  .channel_names(),
              rgb);
    EXPECT_EQ(LayerPlan("", std::vector<double>{450, 540.5}, {}).channel_names(),
              (Names{"R", "G", "B", "A", "total.450nm", "total.540_5nm", "depth.Z"}));
    EXPECT_EQ(LayerPlan("id,default", k_rgb, k_lamps).channel_names(),
              (Names{"R", "G", "B", "A", "depth.Z", "id.V"}));
}

TEST(Layers, LightIsToldFromGroundTruth) {
    for (const char* name :
         {"R", "A", "total.540nm", "direct.R", "multiple.volume.540_5nm", "clean.B", "irradiance.R",
          "error.G", "lamp.depth.Z.R", "order.1.R", "order.more.540nm", "reflections.0.B"})
        EXPECT_TRUE(is_light(name)) << name;
    for (const char* name : {"depth.Z", "range.V", "path.V", "normal.X", "position.Y", "id.V",
                             "lit.V", "transmittance.R", "albedo.G"})
        EXPECT_FALSE(is_light(name)) << name;
    EXPECT_TRUE(is_image_channel("A"));
    EXPECT_TRUE(is_image_channel("total.540_5nm"));
    EXPECT_FALSE(is_image_channel("direct.R"));
    EXPECT_FALSE(is_image_channel("depth.Z"));
}

TEST(Layers, AllHasTheLamps) {
    const LayerPlan plan("all", k_rgb, k_lamps);
    ASSERT_EQ(plan.channel_names().size(), 43u + 6u);
    EXPECT_EQ(plan.first_channel_of_lamp(0), 43);
    EXPECT_EQ(plan.first_channel_of_lamp(1), 46);
    EXPECT_EQ(plan.channel_names()[43], "lamp.left.R");
    EXPECT_EQ(plan.channel_names()[48], "lamp.right.top.B");
}

TEST(Layers, ListInAnyOrderWithSpacesAndRepetition) {
    const LayerPlan plan(" id, depth ,lamp.right.top,id", k_rgb, k_lamps);
    EXPECT_EQ(plan.channel_names(),
              (Names{"R", "G", "B", "A", "depth.Z", "id.V", "lamp.right.top.R", "lamp.right.top.G",
                     "lamp.right.top.B"}));
    EXPECT_TRUE(plan.has(Layer::id));
    EXPECT_FALSE(plan.has(Layer::range));
    EXPECT_EQ(plan.first_channel_of_lamp(0), -1);
    EXPECT_EQ(plan.first_channel_of_lamp(1), 6);
}

TEST(Layers, OtherNumbersOfBandsAreNamedByWavelength) {
    const std::vector<double> bands{450, 540.5};
    const LayerPlan plan("direct,total,lamps", bands, Names{"a"});
    EXPECT_EQ(plan.channel_names(),
              (Names{"R", "G", "B", "A", "total.450nm", "total.540_5nm", "direct.450nm",
                     "direct.540_5nm", "lamp.a.450nm", "lamp.a.540_5nm"}));
    EXPECT_EQ(plan.first_channel(Layer::total), 4);
    const std::vector<double> one{532};
    EXPECT_EQ(LayerPlan("clean", one, {}).channel_names().back(), "clean.532nm");
}

TEST(Layers, CloseWavelengthsKeepTheirOwnNames) {
    const std::vector<double> bands{540, 540.0001, 540.00000001, 600};
    const Names names = LayerPlan("direct", bands, {}).channel_names();
    EXPECT_EQ(std::set(names.begin(), names.end()).size(), names.size());
    EXPECT_NE(message_of<InputError>("direct", {540, 540}).find("twice"), std::string::npos);
}

TEST(Layers, ManyBandsAndLamps) {
    std::vector<double> bands;
    for (int i = 0; i < 32; ++i) bands.push_back(400 + 10 * i);
    Names lamps;
    for (int i = 0; i < 40; ++i) lamps.push_back("lamp" + std::to_string(i));
    const LayerPlan plan("all", bands, lamps);
    EXPECT_EQ(plan.channel_names().size(), 4u + 10u * 32u + 12u + 40u * 32u);
    EXPECT_EQ(plan.channel_names()[static_cast<std::size_t>(plan.first_channel_of_lamp(39)) + 31],
              "lamp.lamp39.710nm");
}

TEST(Layers, RefusesWithOneUsefulLine) {
    for (const char* name : {"flow", "flow_back", "flow_occluded"})
        EXPECT_NE(message_of<UsageError>(name).find("give its --frames"), std::string::npos);
    for (const char* name : {"disparity", "disparity_occluded"})
        EXPECT_NE(message_of<UsageError>(name).find("a rig of at least"), std::string::npos);
    const std::string unknown = message_of<UsageError>("depth,dirct");
    EXPECT_NE(unknown.find("'dirct'"), std::string::npos);
    EXPECT_NE(unknown.find("did you mean 'direct'?"), std::string::npos);
    EXPECT_NE(message_of<UsageError>("everything").find("direct, forward"), std::string::npos);
    EXPECT_NE(message_of<UsageError>("depth,,id").find("unknown layer"), std::string::npos);
    EXPECT_NE(message_of<UsageError>("lamp.middle").find("left, right.top"), std::string::npos);
    EXPECT_NE(message_of<UsageError>("lamp.x", k_rgb, {}).find("no lamps"), std::string::npos);
}

TEST(Layers, WhatCannotBeSuppliedIsLeftOutOrRefused) {
    const auto names = [](std::string_view request, const LayerSupply& supply) {
        return LayerPlan(request, k_rgb, k_lamps, supply).channel_names();
    };
    const Names all = names("all", {.layers = {Layer::multiple, Layer::multiple_volume,
                                               Layer::multiple_surface, Layer::error}});
    ASSERT_EQ(all.size(), 43U + 12U + 6U);
    EXPECT_EQ(Names(all.begin() + 16, all.begin() + 28),
              (Names{"multiple.R", "multiple.G", "multiple.B", "multiple.volume.R",
                     "multiple.volume.G", "multiple.volume.B", "multiple.surface.R",
                     "multiple.surface.G", "multiple.surface.B", "error.R", "error.G", "error.B"}));
    const LayerSupply multiple{
        .layers = {Layer::multiple, Layer::multiple_volume, Layer::multiple_surface}};
    EXPECT_EQ(names("all", multiple).size(), 43U + 9U + 6U);
    EXPECT_EQ(names("multiple.surface", multiple).size(), 4U + 3U);
    for (const char* const name : {"multiple", "multiple.volume", "multiple.surface"})
        EXPECT_EQ(message_of<UsageError>(name),
                  std::string("--layers: ") + name +
                      ": the scene is rendered with single scattering; write --set "
                      "render.scattering=multiple, or --integrator path");
    EXPECT_NE(message_of<UsageError>("error").find("only all light has a standard error"),
              std::string::npos);
    EXPECT_NE(message_of<UsageError>("order.2").find("written with --orders N"), std::string::npos);
    // Whether it is requested or not.
    EXPECT_TRUE(LayerPlan("depth", k_rgb, k_lamps, multiple).is_provided(Layer::multiple));
    EXPECT_FALSE(LayerPlan("all", k_rgb, k_lamps).is_provided(Layer::multiple));
}

TEST(Layers, ASensorHasOneNumberPerPixelOrThree) {
    const LayerSupply number{.layers = {Layer::sensor}, .sensor_values = 1};
    const LayerSupply numbers{.layers = {Layer::sensor}, .sensor_values = 3};
    const LayerPlan one("sensor", k_rgb, k_lamps, number);
    EXPECT_EQ(one.channel_names(), (Names{"R", "G", "B", "A", "sensor.V"}));
    // More bands are needed to make it of.
    const LayerPlan three("sensor", std::vector<double>{450, 540}, {}, numbers);
    EXPECT_EQ(three.channel_names(), (Names{"R", "G", "B", "A", "total.450nm", "total.540nm",
                                            "sensor.R", "sensor.G", "sensor.B"}));
    std::vector<float> pixel(three.channel_names().size());
    EXPECT_EQ(three.channels(Layer::sensor, pixel).data(), &pixel[6]);
    EXPECT_EQ(three.channels(Layer::sensor, pixel).size(), 3U);
    EXPECT_EQ(one.channels(Layer::sensor, pixel).size(), 1U);
    EXPECT_FALSE(is_light("sensor.V"));  // numbers of 16 bits need more than half floats have
    EXPECT_NE(message_of<UsageError>("sensor").find("add camera.sensor"), std::string::npos);
    EXPECT_EQ(LayerPlan("all", k_rgb, k_lamps, number).channel_names().size(),
              LayerPlan("all", k_rgb, k_lamps).channel_names().size() + 1);
}

TEST(Layers, OrdersComeLast) {
    const LayerPlan plan("depth,lamp.left", k_rgb, k_lamps, {.orders = 2});
    const Names& names = plan.channel_names();
    ASSERT_EQ(names.size(), 4U + 1U + 3U + 2U * 4U * 3U);
    EXPECT_EQ(plan.order_count(), 4U);
    EXPECT_EQ(names[8], "order.0.R");
    EXPECT_EQ(names[16], "order.2.B");
    EXPECT_EQ(names[17], "order.more.R");
    EXPECT_EQ(names[20], "reflections.0.R");
    EXPECT_EQ(names.back(), "reflections.more.B");
    std::vector<float> pixel(names.size());
    EXPECT_EQ(plan.order_channels(3, pixel).data(), &pixel[17]);
    EXPECT_EQ(plan.reflection_channels(0, pixel).data(), &pixel[20]);
    EXPECT_EQ(LayerPlan("depth", k_rgb, k_lamps).order_count(), 0U);
}

TEST(Layers, LampNamesThatCannotBeChannels) {
    EXPECT_NE(message_of<InputError>("lamps", k_rgb, {"a", "a"}).find("'a'"), std::string::npos);
    for (const std::string& name :
         {std::string(), std::string("a\0b", 3), std::string("a\nb"), std::string(300, 'x')}) {
        EXPECT_NE(message_of<InputError>("lamps", k_rgb, {name}).find("lamps:"), std::string::npos);
        EXPECT_NO_THROW(LayerPlan("default", k_rgb, Names{name}));
    }
}

}  // namespace
}  // namespace uw
