// ctest labels: unit
#include "core/image/image_file.h"

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

    const test::ImageFile image = test::read_exr(exr_);
    EXPECT_EQ(image.names.size(), plan.channel_names().size());
    EXPECT_EQ(image.metadata.at("compression"), "zip");
    EXPECT_FALSE(image.is_tiled);
    EXPECT_EQ(image.images, 1);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(image.names[c], std::string(1, "RGBA"[c]));
    for (std::size_t c = 0; c < plan.channel_names().size(); ++c) {
        const std::string& name = plan.channel_names()[c];
        ASSERT_TRUE(image.channels.contains(name)) << name;
        EXPECT_EQ(image.formats.at(name), "float");
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 7; ++x) ASSERT_EQ(image.at(name, x, y), value_of(x, y, c)) << name;
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
            EXPECT_EQ(image.metadata.at("compression"), word);
            EXPECT_EQ(image.formats.at("R"), is_half ? "half" : "float");
            EXPECT_EQ(image.formats.at("depth.Z"), "float");
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
    std::vector<std::uint16_t> numbers;
    for (const auto& pixel : preview) numbers.insert(numbers.end(), pixel.begin(), pixel.end());
    EXPECT_EQ(test::numbers_of(test::read_exr(png_), 8), numbers);
}

TEST_F(ImageWriterTest, CropIsTheDataWindowOfTheWholeImage) {
    write_exr(exr_, filled_film(20, 10, {3, 4, 9, 6}, {"R", "G", "B", "A", "depth.Z"}), {});
    const test::ImageFile image = test::read_exr(exr_);
    EXPECT_EQ(image.x, 3);
    EXPECT_EQ(image.y, 4);
    EXPECT_EQ(image.width, 6);
    EXPECT_EQ(image.height, 2);
    EXPECT_EQ(image.full_x, 0);
    EXPECT_EQ(image.full_y, 0);
    EXPECT_EQ(image.full_width, 20);
    EXPECT_EQ(image.full_height, 10);
    EXPECT_EQ(image.at("depth.Z", 3, 4), value_of(3, 4, 4));
    EXPECT_EQ(image.at("depth.Z", 8, 5), value_of(8, 5, 4));
}

TEST_F(ImageWriterTest, MetadataComesBack) {
    const ImageMetadata metadata{{"uwvdb:version", "0.1.0+abc"},
                                 {"uwvdb:seed", 7.0},
                                 {"uwvdb:absorption", "0.3, 0.07, 0.03 1/m"}};
    write_exr(exr_, filled_film(2, 2, {0, 0, 2, 2}, {"R", "G", "B", "A"}), metadata);
    const auto read = test::read_exr(exr_).metadata;
    EXPECT_EQ(read.at("uwvdb:version"), "0.1.0+abc");
    EXPECT_EQ(read.at("uwvdb:absorption"), "0.3, 0.07, 0.03 1/m");
    EXPECT_EQ(read.at("uwvdb:seed"), "7");
}

TEST_F(ImageWriterTest, ChromaticitiesAreStatedOfLinearSrgbAlone) {
    // IEC 61966-2-1: x and y of red, green, blue and white.
    const std::string srgb = "0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329";
    const auto stated_with = [&](const ImageMetadata& metadata) {
        write_exr(exr_, filled_film(2, 2, {0, 0, 2, 2}, {"R", "G", "B", "A"}), metadata);
        const auto read = test::read_exr(exr_).metadata;
        return read.contains("chromaticities") ? read.at("chromaticities") : "";
    };
    EXPECT_EQ(stated_with({{"uwvdb/rgb_space", "linear sRGB"}}), srgb);
    EXPECT_EQ(stated_with({{"uwvdb/rgb_space", "bands"}}), "");
    EXPECT_EQ(stated_with({}), "");
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
    const test::ImageFile read = test::read_exr(png_);
    EXPECT_EQ(read.formats.at("R"), "uint8");
    EXPECT_EQ(read.names.size(), 3U);
    EXPECT_EQ(read.metadata.at("exposure"), "12.5");
    EXPECT_EQ(read.metadata.at("uwvdb:version"), "0.1.0");
    EXPECT_EQ(read.metadata.at("camera"), "\u00e9t\u00e9");
    EXPECT_EQ(read.metadata.at("oiio:ColorSpace"), "sRGB");
    EXPECT_EQ(test::numbers_of(read, 8),
              (std::vector<std::uint16_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 10, 20, 30}));
}

TEST_F(ImageWriterTest, TheSameFilmGivesTheSameBytes) {
    const Film film = filled_film(40, 50, {0, 0, 40, 50}, {"R", "G", "B", "A", "id.V"});
    const fs::path again = directory_.path() / "again.exr";
    write_exr(exr_, film, {{"uwvdb:seed", 1.0}});
    write_exr(again, film, {{"uwvdb:seed", 1.0}});
    EXPECT_EQ(test::file_bytes(exr_), test::file_bytes(again));
    // Written within the same second they would agree on the clock, too.
    EXPECT_FALSE(test::read_exr(exr_).metadata.contains("DateTime"));
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
