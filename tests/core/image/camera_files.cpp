// ctest labels: unit
// The images that cameras store, read back by another library.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "core/base/error.h"
#include "core/image/image_file.h"
#include "core/image/jpeg_file.h"
#include "tests/support/file_bytes.h"
#include "tests/support/full_disk.h"
#include "tests/support/image_file.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

namespace fs = std::filesystem;
using test::limited;

class CameraFiles : public testing::Test {
  protected:
    test::TempDir directory_;
    fs::path png_ = directory_.path() / "image.png";
};

/// What a camera stores: numbers whose two bytes differ.
DigitalImage stored_image(int width, int height, int channels, int bits) {
    DigitalImage image{width, height, channels, bits, false, {}};
    for (int i = 0; i < width * height * channels; ++i)
        image.values.push_back(
            static_cast<std::uint16_t>(bits == 8 ? i * 7 % 256 : i * 2311 % 65536));
    return image;
}

TEST_F(CameraFiles, PngHoldsTheNumbersOfACamera) {
    for (const int channels : {1, 3})
        for (const int bits : {8, 16}) {
            DigitalImage image = stored_image(5, 4, channels, bits);
            for (const bool is_srgb : {false, true}) {
                image.is_srgb = is_srgb;
                write_png(png_, image, {{"uwvdb/frame", "7"}});
                const test::ImageFile read = test::read_exr(png_);
                EXPECT_EQ(read.formats.begin()->second, bits == 8 ? "uint8" : "uint16");
                EXPECT_EQ(read.metadata.at("uwvdb/frame"), "7");
                // The chunk itself: readers take images without it for sRGB as well.
                EXPECT_EQ(test::file_bytes(png_).find("sRGB") != std::string::npos, is_srgb);
                EXPECT_EQ(test::numbers_of(read, bits), image.values);
            }
        }
}

TEST_F(CameraFiles, JpegHoldsTheImageAsWellAsItsQualityAllows) {
    const fs::path jpeg = directory_.path() / "image.jpg";
    const auto write_jpeg = [&](const DigitalImage& image, int quality,
                                const ImageMetadata& metadata) {
        OutputFile out(jpeg);
        write_jpeg_file(out, image, quality, metadata);
        out.commit();
    };
    for (const int channels : {1, 3}) {
        DigitalImage image{64, 48, channels, 8, false, {}};
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < channels; ++c)
                    image.values.push_back(static_cast<std::uint16_t>(2 * x + (2 + c) * y / 2));
        std::uintmax_t last_size = 0;
        for (const auto& [quality, most] : {std::pair{20, 24}, {60, 9}, {95, 3}}) {
            write_jpeg(image, quality, {{"uwvdb/frame", "7"}, {"exposure", 2.5}});
            const test::ImageFile read = test::read_exr(jpeg);
            ASSERT_EQ(read.width, 64);
            ASSERT_EQ(read.height, 48);
            EXPECT_EQ(read.metadata.at("ImageDescription"), "exposure: 2.5\nuwvdb/frame: 7\n");
            const std::vector<std::uint16_t> values = test::numbers_of(read, 8);
            ASSERT_EQ(values.size(), image.values.size());
            int worst = 0;
            for (std::size_t i = 0; i < values.size(); ++i)
                worst = std::max(worst, std::abs(values[i] - image.values[i]));
            // Half a quantisation step of the strongest coefficient, 8 of quality 50, and more for
            // several of them.
            EXPECT_LE(worst, most) << quality;
            EXPECT_GT(fs::file_size(jpeg), last_size);
            last_size = fs::file_size(jpeg);
        }
    }
    std::ofstream(jpeg) << "old";
    const DigitalImage noise = stored_image(200, 200, 3, 8);
    EXPECT_THROW(limited(5000, [&] { write_jpeg(noise, 90, {}); }), IoError);
    EXPECT_EQ(test::file_bytes(jpeg), "old");
    EXPECT_THROW(write_jpeg(stored_image(65536, 1, 1, 8), 90, {}), IoError);
    EXPECT_EQ(test::file_bytes(jpeg), "old");
}

}  // namespace
}  // namespace uw
