// ctest labels: unit
#include "core/image/image_reader.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

std::span<const std::byte> encoded_bytes(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

TEST(ImageReader, ReadsAPngFromMemoryTopRowFirst) {
    const PixelImage image = read_image(encoded_bytes(test::four_texel_png()), "four.png");
    ASSERT_EQ(image.width, 2);
    ASSERT_EQ(image.height, 2);
    ASSERT_EQ(image.channels, 3);
    const std::vector<float> expected = {1, 0, 0, 0,           1,           0,
                                         0, 0, 1, 128 / 255.F, 128 / 255.F, 128 / 255.F};
    for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(image.pixels[k], expected[k], 1e-6);
}

TEST(ImageReader, RefusesBrokenImages) {
    const std::string png = test::four_texel_png();
    EXPECT_THROW(read_image(encoded_bytes("no image"), "x"), InputError);
    EXPECT_THROW(read_image(encoded_bytes(png.substr(0, 20)), "x"), InputError);
    std::string huge = png;  // IHDR: width 2 -> 0x7f000002; its checksum is wrong then, too
    huge[16] = 0x7f;
    EXPECT_THROW(read_image(encoded_bytes(huge), "x"), InputError);
    const test::MeshFolder folder;
    EXPECT_THROW(read_image(folder.path("missing.png")), IoError);
    EXPECT_THROW(read_image(folder.write("text.png", "hello")), InputError);
    EXPECT_EQ(read_image(folder.write("four.png", png)).width, 2);
}

TEST(ImageReader, TellsAFileItCannotOpenFromOneItCannotRead) {
    const test::SceneFolder folder;
    EXPECT_NE(test::message_of<IoError>([&] {
                  read_image(folder.path() / "none.png");
              }).find("no such image file"),
              std::string::npos);
    EXPECT_NE(
        test::message_of<IoError>([&] { read_image(folder.path()); }).find("no such image file"),
        std::string::npos);
    const auto text = folder.write("text.png", "hello\nworld\n");
    EXPECT_TRUE(test::message_of<InputError>([&] {
                    read_image(text);
                }).starts_with(text.string() + ": cannot read the image"));
    EXPECT_NE(test::message_of<InputError>([&] {
                  read_image(encoded_bytes("GIF89a"), "x");
              }).find("x: neither PNG nor JPEG"),
              std::string::npos);
}

TEST(ImageReader, ReadsFloatsAsTheyWereWritten) {
    const test::SceneFolder folder;
    Film film(2, 1, {0, 0, 2, 1}, {"R", "G", "B", "A"});
    const std::vector<float> values{0.1F, -2, 1e6F, 1, 0.25F, 3, 0, 1};
    for (int x = 0; x < 2; ++x)
        for (std::size_t c = 0; c < 4; ++c)
            film.pixel(x, 0)[c] = values[4 * static_cast<std::size_t>(x) + c];
    write_exr(folder.path() / "a.exr", film, {});
    const PixelImage image = read_image(folder.path() / "a.exr");
    EXPECT_EQ(image.channels, 4);
    EXPECT_EQ(image.pixels, values);
}

class ImageHeader : public testing::Test {
  protected:
    ImageHeader() {
        const Film film(8, 6, window_, names_);
        write_exr(file_, film, {{"scene", std::string("ab12")}, {"samples", 16.0}});
    }
    bool fits(const ImageLayout& layout, const ImageMetadata& metadata = {}) const {
        return has_header_of(file_, layout, metadata);
    }

    const PixelWindow window_{1, 2, 7, 5};
    const std::vector<std::string> names_{"R", "G", "B", "A", "Z"};
    const test::SceneFolder folder_;
    const std::filesystem::path file_ = folder_.path() / "a.exr";
};

TEST_F(ImageHeader, IsOfTheSameLayout) {
    EXPECT_TRUE(fits({8, 6, window_, names_}));
    EXPECT_TRUE(fits({8, 6, window_, {"Z", "A", "B", "G", "R"}}));  // files have their own order
    EXPECT_FALSE(fits({9, 6, window_, names_}));
    EXPECT_FALSE(fits({8, 7, window_, names_}));
    EXPECT_FALSE(fits({8, 6, {1, 2, 7, 6}, names_}));
    EXPECT_FALSE(fits({8, 6, {0, 2, 6, 5}, names_}));
    EXPECT_FALSE(fits({8, 6, window_, {"R", "G", "B", "A"}}));
    EXPECT_FALSE(fits({8, 6, window_, {"R", "G", "B", "A", "Y"}}));
}

TEST_F(ImageHeader, HasAllOfTheMetadata) {
    const ImageLayout layout{8, 6, window_, names_};
    EXPECT_TRUE(fits(layout, {{"scene", std::string("ab12")}}));
    EXPECT_TRUE(fits(layout, {{"scene", std::string("ab12")}, {"samples", 16.0}}));
    EXPECT_FALSE(fits(layout, {{"scene", std::string("ab13")}}));
    EXPECT_FALSE(fits(layout, {{"samples", 17.0}}));
    EXPECT_FALSE(fits(layout, {{"scene", std::string("ab12")}, {"other", std::string("x")}}));
}

TEST_F(ImageHeader, IsNoneOfWhatCannotBeRead) {
    const ImageLayout layout{8, 6, window_, names_};
    EXPECT_FALSE(has_header_of(folder_.path() / "none.exr", layout, {}));
    EXPECT_FALSE(has_header_of(folder_.path(), layout, {}));
    EXPECT_FALSE(has_header_of(folder_.write("text.exr", "no image"), layout, {}));
}

}  // namespace
}  // namespace uw
