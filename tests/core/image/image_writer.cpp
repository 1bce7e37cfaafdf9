// ctest labels: unit
#include "core/image/image_file.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/layers.h"
#include "tests/support/file_bytes.h"
#include "tests/support/full_disk.h"
#include "tests/support/image_file.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

namespace fs = std::filesystem;
using test::limited;

/// A value that no other channel or pixel has, and that a half float cannot hold.
float value_of(int x, int y, std::size_t channel) {
    return 1000.0f * static_cast<float>(y) + 10.0f * static_cast<float>(x) +
           0.01f * static_cast<float>(channel) + 1.0f / 3.0f;
}

Film filled_film(int width, int height, const PixelWindow& window,
                 const std::vector<std::string>& names) {
    Film film(width, height, window, names);
    for (int y = window.y0; y < window.y1; ++y) {
        for (int x = window.x0; x < window.x1; ++x) {
            const auto pixel = film.pixel(x, y);
            for (std::size_t c = 0; c < pixel.size(); ++c) pixel[c] = value_of(x, y, c);
        }
    }
    return film;
}

class ImageWriterTest : public testing::Test {
  protected:
    test::TempDir directory_;
    fs::path exr_ = directory_.path() / "image.exr";
    fs::path png_ = directory_.path() / "image.png";
};

TEST_F(ImageWriterTest, EveryChannelComesBackBitForBit) {
    const std::vector<double> bands{450, 532.5, 540, 620};
    const std::vector<std::string> lamps{"left", "right.top"};
    const LayerPlan plan("all", bands, lamps);
    const Film film = filled_film(7, 5, {0, 0, 7, 5}, plan.channel_names());
    write_exr(exr_, film, {});

    const auto input = OIIO::ImageInput::open(exr_.string());
    ASSERT_TRUE(input) << OIIO::geterror();
    const OIIO::ImageSpec& spec = input->spec();
    EXPECT_EQ(spec.nchannels, static_cast<int>(plan.channel_names().size()));
    EXPECT_EQ(spec.format, OIIO::TypeFloat);
    EXPECT_TRUE(spec.channelformats.empty());  // no channel differs: none is half
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
    EXPECT_EQ(spec.tile_width, 0);
    EXPECT_FALSE(input->seek_subimage(1, 0));
    ASSERT_TRUE(input->seek_subimage(0, 0));
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(spec.channelnames[c], std::string(1, "RGBA"[c]));

    std::vector<float> pixels(static_cast<std::size_t>(spec.nchannels) * 7 * 5);
    ASSERT_TRUE(input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, pixels.data()));
    for (std::size_t c = 0; c < plan.channel_names().size(); ++c) {
        const int stored = spec.channelindex(plan.channel_names()[c]);
        ASSERT_GE(stored, 0) << plan.channel_names()[c];
        for (int y = 0; y < 5; ++y) {
            for (int x = 0; x < 7; ++x) {
                const auto at = static_cast<std::size_t>((y * 7 + x) * spec.nchannels + stored);
                ASSERT_EQ(pixels[at], value_of(x, y, c)) << plan.channel_names()[c];
            }
        }
    }
}

/// Width, height and lines per block that do not divide each other; noise that does not compress,
/// and lines that do.
TEST_F(ImageWriterTest, EveryCompressionAndPrecisionComesBack) {
    const std::vector<std::string> names{"R", "G", "B", "A", "depth.Z"};
    Film film(41, 45, {2, 3, 39, 40}, names);
    std::uint32_t random = 1;
    for (int y = 3; y < 40; ++y)
        for (int x = 2; x < 39; ++x)
            for (float& value : film.pixel(x, y)) {
                random = random * 1664525u + 1013904223u;
                value = y < 20 ? static_cast<float>(random) * 0x1p-30F : 0.25F;
            }
    for (const auto& [word, compression] : k_compression_names) {
        for (const auto& [precision_word, precision] : k_precision_names) {
            write_exr(exr_, film, {}, {precision, compression});
            const test::ImageFile image = test::read_exr(exr_);
            const bool is_half = precision != ExrOptions::Precision::single;
            for (int y = 3; y < 40; ++y)
                for (int x = 2; x < 39; ++x)
                    for (std::size_t c = 0; c < names.size(); ++c) {
                        const float value = film.pixel(x, y)[c];
                        const float stored = image.at(names[c], x, y);
                        if (is_half && c < 4)
                            ASSERT_LE(std::abs(stored - value), 0x1p-11F * value) << word;
                        else
                            ASSERT_EQ(stored, value) << word << " " << precision_word;
                    }
            const auto input = OIIO::ImageInput::open(exr_.string());
            ASSERT_TRUE(input) << OIIO::geterror();
            EXPECT_EQ(input->spec().get_string_attribute("compression").str(), word);
            EXPECT_EQ(input->spec().channelformat(0), is_half ? OIIO::TypeHalf : OIIO::TypeFloat);
            EXPECT_EQ(input->spec().channelformat(4), OIIO::TypeFloat);
        }
    }
}

TEST_F(ImageWriterTest, HalfFloatsOverflowWhereHalfLossSaysSo) {
    Film film(2, 1, {0, 0, 2, 1}, {"R", "G", "B", "A"});
    film.pixel(0, 0)[k_red] = -65519;
    film.pixel(1, 0)[k_red] = std::nextafter(65520.0F, 0.0F);
    film.pixel(0, 0)[k_green] = 65520;
    film.pixel(1, 0)[k_green] = -1e30F;
    ASSERT_EQ(half_loss(film).too_large, 2U);
    write_exr(exr_, film, {}, {ExrOptions::Precision::half, ExrCompression::zip});
    const test::ImageFile image = test::read_exr(exr_);
    EXPECT_EQ(image.at("R", 0, 0), -65504);
    EXPECT_EQ(image.at("R", 1, 0), 65504);
    EXPECT_EQ(image.at("G", 0, 0), std::numeric_limits<float>::infinity());
    EXPECT_EQ(image.at("G", 1, 0), -std::numeric_limits<float>::infinity());
}

TEST_F(ImageWriterTest, BytesDoNotDependOnThreads) {
    const Film film = filled_film(200, 300, {0, 0, 200, 300}, {"R", "G", "B", "A", "depth.Z"});
    Preview preview(900, 700);
    for (std::size_t i = 0; i < preview.size(); ++i)
        preview[i] = {static_cast<std::uint8_t>(i / 7), static_cast<std::uint8_t>(i * i / 91), 7};
    std::vector<std::string> written;
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        write_exr(exr_, film, {});
        write_png(png_, preview, {});
        written.push_back(test::file_bytes(exr_) + test::file_bytes(png_));
    }
    EXPECT_EQ(written[0], written[1]);
    EXPECT_EQ(written[0], written[2]);
    const auto input = OIIO::ImageInput::open(png_.string());
    ASSERT_TRUE(input) << OIIO::geterror();
    Preview read(900, 700);
    ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeUInt8, read.values().data()));
    EXPECT_TRUE(std::ranges::equal(read, preview));
}

TEST_F(ImageWriterTest, CropIsTheDataWindowOfTheWholeImage) {
    write_exr(exr_, filled_film(20, 10, {3, 4, 9, 6}, {"R", "G", "B", "A", "depth.Z"}), {});
    const auto input = OIIO::ImageInput::open(exr_.string());
    ASSERT_TRUE(input) << OIIO::geterror();
    const OIIO::ImageSpec& spec = input->spec();
    EXPECT_EQ(spec.x, 3);
    EXPECT_EQ(spec.y, 4);
    EXPECT_EQ(spec.width, 6);
    EXPECT_EQ(spec.height, 2);
    EXPECT_EQ(spec.full_x, 0);
    EXPECT_EQ(spec.full_y, 0);
    EXPECT_EQ(spec.full_width, 20);
    EXPECT_EQ(spec.full_height, 10);
    std::vector<float> depth(12);
    const int channel = spec.channelindex("depth.Z");
    ASSERT_TRUE(input->read_image(0, 0, channel, channel + 1, OIIO::TypeFloat, depth.data()));
    EXPECT_EQ(depth.front(), value_of(3, 4, 4));
    EXPECT_EQ(depth.back(), value_of(8, 5, 4));
}

TEST_F(ImageWriterTest, MetadataComesBack) {
    const ImageMetadata metadata{{"uwvdb:version", "0.1.0+abc"},
                                 {"uwvdb:seed", 7.0},
                                 {"uwvdb:absorption", "0.3, 0.07, 0.03 1/m"}};
    write_exr(exr_, filled_film(2, 2, {0, 0, 2, 2}, {"R", "G", "B", "A"}), metadata);
    const auto input = OIIO::ImageInput::open(exr_.string());
    ASSERT_TRUE(input) << OIIO::geterror();
    EXPECT_EQ(input->spec().get_string_attribute("uwvdb:version"), "0.1.0+abc");
    EXPECT_EQ(input->spec().get_string_attribute("uwvdb:absorption"), "0.3, 0.07, 0.03 1/m");
    EXPECT_EQ(input->spec().get_float_attribute("uwvdb:seed"), 7.0f);
}

TEST_F(ImageWriterTest, ChromaticitiesAreStatedOfLinearSrgbAlone) {
    // IEC 61966-2-1: x and y of red, green, blue and white.
    const std::array<float, 8> srgb{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
    const auto stated_with = [&](const ImageMetadata& metadata, std::array<float, 8>& stated) {
        write_exr(exr_, filled_film(2, 2, {0, 0, 2, 2}, {"R", "G", "B", "A"}), metadata);
        const auto input = OIIO::ImageInput::open(exr_.string());
        return input &&
               input->spec().getattribute("chromaticities",
                                          OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), stated.data());
    };
    std::array<float, 8> stated{};
    ASSERT_TRUE(stated_with({{"uwvdb/rgb_space", "linear sRGB"}}, stated));
    EXPECT_EQ(stated, srgb);
    EXPECT_FALSE(stated_with({{"uwvdb/rgb_space", "bands"}}, stated));
    EXPECT_FALSE(stated_with({}, stated));
}

TEST_F(ImageWriterTest, LongNamesComeBack) {
    const std::string name(100, 'n'), lamp = "lamp." + std::string(200, 'l') + ".R";
    write_exr(exr_, filled_film(2, 2, {0, 0, 2, 2}, {"R", "G", "B", "A", lamp}), {{name, "x"}});
    const test::ImageFile image = test::read_exr(exr_);
    EXPECT_EQ(image.metadata.at(name), "x");
    EXPECT_EQ(image.at(lamp, 1, 1), value_of(1, 1, 4));
}

TEST_F(ImageWriterTest, PngHoldsThePreviewAndItsExposure) {
    Preview image(2, 2);
    image(0, 0) = {255, 0, 0};
    image(1, 0) = {0, 255, 0};
    image(0, 1) = {0, 0, 255};
    image(1, 1) = {10, 20, 30};
    write_png(png_, image,
              {{"exposure", 12.5}, {"uwvdb:version", "0.1.0"}, {"camera", "\u00e9t\u00e9"}});
    const auto input = OIIO::ImageInput::open(png_.string());
    ASSERT_TRUE(input) << OIIO::geterror();
    EXPECT_EQ(input->spec().format, OIIO::TypeUInt8);
    EXPECT_EQ(input->spec().nchannels, 3);
    EXPECT_EQ(input->spec().get_string_attribute("exposure"), "12.5");
    EXPECT_EQ(input->spec().get_string_attribute("uwvdb:version"), "0.1.0");
    EXPECT_EQ(input->spec().get_string_attribute("camera"), "\u00e9t\u00e9");
    EXPECT_EQ(input->spec().get_string_attribute("oiio:ColorSpace"), "sRGB");
    std::vector<std::uint8_t> pixels(12);
    ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeUInt8, pixels.data()));
    EXPECT_EQ(pixels, (std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30}));
}

TEST_F(ImageWriterTest, TheSameFilmGivesTheSameBytes) {
    const Film film = filled_film(40, 50, {0, 0, 40, 50}, {"R", "G", "B", "A", "id.V"});
    const fs::path again = directory_.path() / "again.exr";
    write_exr(exr_, film, {{"uwvdb:seed", 1.0}});
    write_exr(again, film, {{"uwvdb:seed", 1.0}});
    EXPECT_EQ(test::file_bytes(exr_), test::file_bytes(again));
    // Written within the same second they would agree on the clock, too.
    const auto input = OIIO::ImageInput::open(exr_.string());
    ASSERT_TRUE(input) << OIIO::geterror();
    EXPECT_EQ(input->spec().get_string_attribute("DateTime"), "");
}

TEST_F(ImageWriterTest, AFullDiskLeavesTheOldFile) {
    std::ofstream(exr_) << "old";
    std::ofstream(png_) << "old";
    const Film film = filled_film(64, 64, {0, 0, 64, 64}, {"R", "G", "B", "A", "depth.Z"});
    Preview noise(64, 64);
    for (std::size_t i = 0; i < 3 * noise.size(); ++i) {
        noise[i / 3][i % 3] = static_cast<std::uint8_t>(i * i * 2654435761u >> 13);
    }
    const fs::path whole = directory_.path() / "whole";
    write_exr(whole, film, {});
    const rlim_t exr_size = fs::file_size(whole);
    write_png(whole, noise, {});
    const rlim_t png_size = fs::file_size(whole);
    fs::remove(whole);
    for (const rlim_t missing : {1, 100, 5000}) {
        EXPECT_THROW(limited(exr_size - missing, [&] { write_exr(exr_, film, {}); }), IoError);
        EXPECT_THROW(limited(png_size - missing, [&] { write_png(png_, noise, {}); }), IoError);
    }
    EXPECT_THROW(limited(0, [&] { write_exr(exr_, film, {}); }), IoError);
    EXPECT_THROW(limited(0, [&] { write_png(png_, noise, {}); }), IoError);
    EXPECT_EQ(test::file_bytes(exr_), "old");
    EXPECT_EQ(test::file_bytes(png_), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(directory_.path()), fs::directory_iterator()),
              2);
}

TEST_F(ImageWriterTest, AFileInPlaceOfAFolderIsAnIoErrorOfOneLine) {
    const Film film(1, 1, {0, 0, 1, 1}, {"R", "G", "B", "A"});
    try {
        write_exr(exr_, film, {});
        write_exr(exr_ / "image.exr", film, {});
        FAIL();
    } catch (const IoError& error) {
        EXPECT_NE(std::string(error.what()).find("not a folder"), std::string::npos);
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
}

}  // namespace
}  // namespace uw
