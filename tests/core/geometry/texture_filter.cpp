// ctest labels: unit analytic
// Textures looked up over parallelograms, and in files that are read in parts.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/mesh.h"
#include "core/image/image_file.h"
#include "core/image/image_formats.h"
#include "tests/support/image_file.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

constexpr TextureLookup k_clamped{TextureFilter::linear, TextureWrap::clamp, TextureWrap::clamp};

std::vector<int> noise(int width, int height, int channels, int most) {
    std::mt19937 random(7);
    std::vector<int> values(static_cast<std::size_t>(width * height * channels));
    for (int& value : values) value = static_cast<int>(random() % static_cast<unsigned>(most + 1));
    return values;
}

Texture linear_texture(int width, int height, const std::vector<float>& grey) {
    return Texture(PixelImage{width, height, 1, grey, true});
}

TEST(TextureFilter, ChangesNothingWithinATexel) {
    std::vector<float> values;
    for (const int value : noise(13, 9, 1, 255)) values.push_back(static_cast<float>(value) / 255);
    const Texture texture = linear_texture(13, 9, values);
    for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear})
        for (int i = 0; i < 50; ++i) {
            const double u = 0.37 * i, v = 0.11 * i;
            EXPECT_EQ(texture.sample(u, v, {filter}, {{0.99 / 13, 0}, {0, 0.99 / 9}}),
                      texture.sample(u, v, {filter}));
        }
}

TEST(TextureFilter, OfARampIsItsMiddle) {
    // What is linear has its value at the centre as its mean, over any parallelogram.
    constexpr int k_size = 128;
    std::vector<float> values;
    for (int y = 0; y < k_size; ++y)
        for (int x = 0; x < k_size; ++x)
            values.push_back(static_cast<float>(0.004 * (x + 0.5) + 0.003 * (y + 0.5)));
    const Texture texture = linear_texture(k_size, k_size, values);
    for (const TextureSpread& spread :
         {TextureSpread{{0.05, 0}, {0, 0.05}}, TextureSpread{{0.2, 0.1}, {-0.01, 0.02}},
          TextureSpread{{0.01, 0.01}, {0.1, -0.15}}, TextureSpread{{0.08, 0}, {0.08, 0.001}}})
        EXPECT_NEAR(texture.sample(0.5, 0.45, k_clamped, spread)[0],
                    k_size * (0.004 * 0.5 + 0.003 * 0.45), 1e-6);
}

TEST(TextureFilter, OfTheWholeIsItsMeanInLinearLight) {
    // Of odd sides, too, where texels of the halves are of three.
    for (const auto& [width, height] : {std::pair{64, 32}, {37, 23}, {5, 1}, {1, 7}}) {
        const std::vector<int> codes = noise(width, height, 1, 255);
        std::vector<float> values;
        double mean = 0;
        for (const int code : codes) {
            values.push_back(static_cast<float>(code) / 255);
            mean += linear_from_srgb(code / 255.0) / static_cast<double>(codes.size());
        }
        const Texture texture(PixelImage{width, height, 1, values});
        for (const double v : texture.sample(0.3, 0.8, {}, {{8, 0}, {0, 8}}))
            EXPECT_NEAR(v, mean, 1e-6) << width << " x " << height;
    }
}

TEST(TextureFilter, HasAGradientThatIsItsTranspose) {
    // Some sides are odd, and spreads reach over edges and take coarse halves.
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (const auto& [width, height] : {std::pair{16, 8}, {13, 7}, {1, 5}, {1, 1}}) {
        PixelImage image{width, height, 3, {}, true};
        for (int i = 0; i < 3 * width * height; ++i)
            image.pixels.push_back(static_cast<float>(uniform(random)));
        const Texture texture(image);
        TextureGradient gradient(texture);
        double sum = 0;
        for (int i = 0; i < 60; ++i) {
            const double u = 2 * uniform(random) - 0.5, v = 2 * uniform(random) - 0.5;
            const double size = i % 3 == 0 ? 0 : 0.6 * uniform(random);
            const TextureSpread spread{{size * uniform(random), size * uniform(random)},
                                       {-size * uniform(random), size * uniform(random)}};
            const TextureLookup lookup = i % 2 == 0 ? k_clamped : TextureLookup{};
            const Rgb weights{uniform(random), -uniform(random), 2 * uniform(random)};
            gradient.add(u, v, lookup, spread, weights);
            const Rgb found = texture.sample(u, v, lookup, spread);
            for (std::size_t c = 0; c < 3; ++c) sum += weights[c] * found[c];
        }
        double by_texel = 0;
        const std::vector<double> values = gradient.by_texel();
        ASSERT_EQ(values.size(), image.pixels.size());
        for (std::size_t i = 0; i < values.size(); ++i)
            by_texel += values[i] * static_cast<double>(image.pixels[i]);
        EXPECT_NEAR(by_texel, sum, 1e-5) << width << " x " << height;  // halves are floats
    }
}

TEST(TextureFilter, KeepsWhatIsSharpBesideALongSide) {
    // Stripes along u: a parallelogram as long as 60 texels along them and less than one across
    // sees the stripe that a point sees.
    constexpr int k_size = 64;
    std::vector<float> values;
    for (int y = 0; y < k_size; ++y)
        for (int x = 0; x < k_size; ++x) values.push_back(y % 8 < 4 ? 1.0F : 0.0F);
    const Texture texture = linear_texture(k_size, k_size, values);
    // A 16th of 14 texels is less than one: no coarser image is looked at.
    const TextureSpread along{{14.0 / k_size, 0}, {0, 0.5 / k_size}};
    const TextureSpread across{{0, 16.0 / k_size}, {0.5 / k_size, 0}};
    for (int i = 0; i < 100; ++i) {
        const double v = 0.3 + 0.004 * i;
        EXPECT_NEAR(texture.sample(0.5, v, k_clamped, along)[0],
                    texture.sample(0.5, v, k_clamped)[0], 1e-9);
        EXPECT_NEAR(texture.sample(0.5, v, k_clamped, across)[0], 0.5, 1e-9);  // two periods
    }
}

TEST(TextureFilter, IsNearTheMeanOverTheSquare) {
    // Noise of single texels: its mean over w x w texels has a deviation of 1/w of theirs, and what
    // is left of the difference to it must be a part of that.
    constexpr int k_size = 256;
    std::vector<float> values;
    for (const int value : noise(k_size, k_size, 1, 255))
        values.push_back(static_cast<float>(value) / 255);
    const Texture texture = linear_texture(k_size, k_size, values);
    const double deviation = std::sqrt(1.0 / 12);
    for (const double width : {2.0, 3.0, 5.3, 8.0, 11.7}) {
        double variance = 0, off = 0;
        constexpr int k_places = 400, k_grid = 48;
        for (int place = 0; place < k_places; ++place) {
            const double u = 0.2 + 0.0137 * (place % 40), v = 0.2 + 0.0591 * (place / 40);
            double mean = 0;
            for (int j = 0; j < k_grid; ++j)
                for (int i = 0; i < k_grid; ++i)
                    mean += texture.sample(u + ((i + 0.5) / k_grid - 0.5) * width / k_size,
                                           v + ((j + 0.5) / k_grid - 0.5) * width / k_size,
                                           k_clamped)[0] /
                            (k_grid * k_grid);
            const double filtered =
                texture.sample(u, v, k_clamped, {{width / k_size, 0}, {0, width / k_size}})[0];
            variance += (filtered - 0.5) * (filtered - 0.5) / k_places;
            off += (filtered - mean) * (filtered - mean) / k_places;
        }
        EXPECT_LT(std::sqrt(variance), 1.1 * deviation / width) << width;  // no noise of its own
        EXPECT_LT(std::sqrt(off), 0.8 * deviation / width) << width;
    }
}

/// An image that is read in parts, and the same as a whole.
class TextureParts : public testing::Test {
  protected:
    void write(const std::string& ending, int width, int height, int channels, int bits) {
        file_ = folder_.path() / ("image." + ending);
        const std::string bytes = test::encoded_image(
            ending, width, height, channels, noise(width, height, channels, (1 << bits) - 1), bits);
        std::ofstream(file_, std::ios::binary) << bytes;
    }
    test::TempDir folder_;
    std::filesystem::path file_;
};

TEST_F(TextureParts, AreThoseOfTheWhole) {
    for (const int bits : {8, 16})
        for (const int channels : {1, 3, 4}) {
            write("tif", 256, 128, channels, bits);
            const auto parts = open_partial_image(file_, 1000);
            ASSERT_NE(parts, nullptr);
            const Texture whole(read_image(file_), TextureEncoding::srgb, true);
            // Two finer images are looked up in the file, the one of 64 x 32 texels is in memory.
            const Texture texture(parts, "image", TextureEncoding::srgb, true, 64 * 32);
            for (int i = 0; i < 200; ++i) {
                const double u = 0.137 * i, v = 0.071 * i;
                EXPECT_NEAR(texture.sample_alpha(u, v, {}), whole.sample_alpha(u, v, {}), 1e-6);
                for (const double width : {0.0, 1.5, 2.7, 6.0, 40.0}) {
                    const TextureSpread spread{{width / 256, 0}, {0, width / 128}};
                    const Rgb a = texture.sample(u, v, {}, spread);
                    const Rgb b = whole.sample(u, v, {}, spread);
                    for (std::size_t c = 0; c < 3; ++c)
                        ASSERT_NEAR(a.at(c), b.at(c), 1e-5) << channels << " " << width;
                }
            }
        }
}

TEST_F(TextureParts, CoverATextureOfOddSides) {
    write("tif", 203, 91, 3, 8);
    const auto parts = open_partial_image(file_, 1000);
    ASSERT_NE(parts, nullptr);
    const Texture whole(read_image(file_), TextureEncoding::srgb);
    const Texture texture(parts, "image", TextureEncoding::srgb, false, 30 * 20);
    for (int i = 0; i < 100; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            ASSERT_NEAR(texture.sample(0.0137 * i, 0.0071 * i, {})[c],
                        whole.sample(0.0137 * i, 0.0071 * i, {})[c], 1e-6);
    double mean_of_parts = 0, mean_of_whole = 0;
    constexpr int k_places = 2000;
    for (int i = 0; i < k_places; ++i) {
        const double u = std::fmod(0.618034 * i, 1.0), v = (i + 0.5) / k_places;
        const TextureSpread spread{{9.0 / 203, 0}, {0, 9.0 / 91}};
        mean_of_parts += texture.sample(u, v, {}, spread)[0] / k_places;
        mean_of_whole += whole.sample(u, v, {}, spread)[0] / k_places;
    }
    EXPECT_NEAR(mean_of_parts, mean_of_whole, 2e-3);
}

TEST_F(TextureParts, AreForLargeFilesOfFormatsThatHaveThem) {
    write("tif", 64, 32, 3, 8);
    EXPECT_EQ(open_partial_image(file_), nullptr);
    EXPECT_EQ(open_partial_image(file_, 64 * 32), nullptr);
    EXPECT_NE(open_partial_image(file_, 64 * 32 - 1), nullptr);
    write("png", 64, 32, 3, 8);
    EXPECT_EQ(open_partial_image(file_, 1), nullptr);
    EXPECT_THROW(open_partial_image(folder_.path() / "none.tif", 1), IoError);
}

TEST_F(TextureParts, OfADamagedFileAreRefused) {
    write("tif", 256, 256, 3, 8);
    std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
    const auto parts = open_partial_image(file_, 1000);
    ASSERT_NE(parts, nullptr);
    EXPECT_THROW(Texture(parts, "image", TextureEncoding::srgb, false, 100), InputError);
}

}  // namespace
}  // namespace uw
