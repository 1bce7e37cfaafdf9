// ctest labels: unit analytic
#include "core/image/exr_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/image/layers.h"

namespace uw {
namespace {

Film grey(float value, const std::vector<std::string>& names = {"R", "G", "B", "A", "depth.Z"}) {
    Film film(4, 2, {0, 0, 4, 2}, names);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x) {
            for (float& channel : film.pixel(x, y)) channel = value;
            film.pixel(x, y)[k_alpha] = 1;
        }
    return film;
}

std::string half_channels(const Film& film, ExrOptions::Precision precision) {
    std::string text;
    for (const ExrChannel& channel : exr_channels(film, precision))
        if (channel.is_half) text += channel.name + " ";
    return text;
}

TEST(ExrOptions, ImagesAreHalfAndGroundTruthIsNot) {
    using enum ExrOptions::Precision;
    EXPECT_EQ(half_channels(grey(1), automatic), "A B G R ");
    EXPECT_EQ(half_channels(grey(1), half), "A B G R ");
    EXPECT_EQ(half_channels(grey(1), single), "");
    EXPECT_EQ(half_channels(grey(1, {"R", "G", "B", "A", "total.540nm", "id.V"}), automatic),
              "A B G R total.540nm ");
}

// direct + forward + backscatter is the total to the bit.
TEST(ExrOptions, LayersOfLightStayExact) {
    using enum ExrOptions::Precision;
    for (const std::string light : {"direct.R", "lamp.left.R", "order.more.540_5nm", "error.R"}) {
        const Film film = grey(1, {"R", "G", "B", "A", light});
        EXPECT_EQ(half_channels(film, automatic), "") << light;
        EXPECT_EQ(half_channels(film, half), "A B G R " + light + " ");
    }
}

TEST(ExrOptions, WhatHalfFloatsCannotHoldIsFloat) {
    using enum ExrOptions::Precision;
    // Halves below 2^-14 are 2^-24 apart: the largest error is 2^-25, here 1.2e-4 of the mean.
    EXPECT_EQ(half_channels(grey(0x1p-12F), automatic), "A B G R ");
    EXPECT_EQ(half_channels(grey(0.99F * 0x1p-12F), automatic), "");
    EXPECT_TRUE(half_loss(grey(0.99F * 0x1p-12F)).too_dark);
    EXPECT_EQ(half_channels(grey(0), automatic), "A B G R ");  // black is exact

    Film film = grey(1);
    film.pixel(3, 1)[k_green] = -65519;
    EXPECT_TRUE(half_loss(film).is_none());
    film.pixel(2, 1)[k_blue] = 65520;
    film.pixel(3, 1)[k_green] = -1e9F;
    EXPECT_EQ(half_loss(film).too_large, 2U);
    EXPECT_EQ(half_channels(film, automatic), "");
    EXPECT_EQ(half_channels(film, half), "A B G R ");
    film.pixel(2, 1)[k_blue] = 1;
    film.pixel(3, 1)[k_green] = 1;
    film.pixel(3, 1)[4] = 1e9F;  // ground truth does not matter
    EXPECT_TRUE(half_loss(film).is_none());
    // Infinite as they are, and no reason to make all the others longer.
    film.pixel(0, 0)[k_red] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(half_loss(film).too_large, 0U);
}

TEST(ExrOptions, ChannelsAreSortedByName) {
    const LayerPlan plan("all", std::vector<double>{620, 540, 450}, std::vector<std::string>{"a"});
    const auto channels = exr_channels(grey(1, plan.channel_names()), ExrOptions::Precision::half);
    EXPECT_TRUE(std::ranges::is_sorted(channels, {}, &ExrChannel::name));
    EXPECT_EQ(channels.size(), plan.channel_names().size());
}

}  // namespace
}  // namespace uw
