// ctest labels: unit
#include "core/image/image_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/mesh.h"
#include "tests/support/image_file.h"
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

/// 5 x 5 grey pixels of 29 x + 40 y modulo 256 in the seven passes of Adam7, as hexadecimal digits.
constexpr std::string_view k_interlaced_png =
    "89504e470d0a1a0a0000000d4948445200000005000000050800000001df0349af0000002d494441"
    "5478da63606028615820c260c5708b21a0eb08836c3843ee7286bddf19345c93eae730544cdd74fe"
    "0d00b0b50c7bd499d7620000000049454e44ae426082";

TEST(ImageReader, ReadsInterlacedPngs) {
    std::string bytes;
    for (std::size_t at = 0; at < k_interlaced_png.size(); at += 2)
        bytes +=
            static_cast<char>(std::stoi(std::string(k_interlaced_png.substr(at, 2)), nullptr, 16));
    const PixelImage image = read_image(encoded_bytes(bytes), "interlaced.png");
    ASSERT_EQ(image.pixels.size(), 25U);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x)
            EXPECT_NEAR(image.pixels[static_cast<std::size_t>(5 * y + x)],
                        ((29 * x + 40 * y) % 256) / 255.0, 1e-6)
                << x << ", " << y;
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
              }).find("no such file"),
              std::string::npos);
    EXPECT_NE(test::message_of<IoError>([&] { read_image(folder.path()); }).find("is a folder"),
              std::string::npos);
    const auto text = folder.write("text.png", "hello\nworld\n");
    EXPECT_TRUE(test::message_of<InputError>([&] {
                    read_image(text);
                }).starts_with(text.string() + ": cannot read the image"));
    EXPECT_NE(test::message_of<InputError>([&] {
                  read_image(encoded_bytes("GIF89a"), "x");
              }).find("x: cannot read the image: none of the formats known"),
              std::string::npos);
}

/// An image of values that tell every place from the others, and what is read of it.
struct Decoded {
    std::vector<int> values;
    PixelImage image;
};
Decoded decoded(const std::string& format, int channels, int bits = 8) {
    constexpr int k_columns = 5, k_rows = 3;
    Decoded result;
    for (int i = 0; i < k_columns * k_rows * channels; ++i)
        result.values.push_back(i * (bits == 16 ? 1091 : 4) + 1);
    const std::string bytes =
        test::encoded_image(format, k_columns, k_rows, channels, result.values, bits);
    result.image = read_image(encoded_bytes(bytes), "x." + format);
    EXPECT_EQ(result.image.width, k_columns);
    EXPECT_EQ(result.image.height, k_rows);
    return result;
}

TEST(ImageReader, ReadsEveryKindOfPngExactly) {
    for (const int bits : {8, 16}) {
        for (const int channels : {1, 2, 3, 4}) {
            const auto [values, image] = decoded("png", channels, bits);
            ASSERT_EQ(image.channels, channels);
            ASSERT_EQ(image.pixels.size(), values.size());
            const double most = (1 << bits) - 1;
            for (std::size_t i = 0; i < values.size(); ++i)
                EXPECT_NEAR(image.pixels[i], values[i] / most, 1e-7) << bits << " " << channels;
        }
    }
}

TEST(ImageReader, ReadsJpegAsFarAsItIsExact) {
    for (const int channels : {1, 3}) {
        const auto [values, image] = decoded("jpg", channels);
        ASSERT_EQ(image.channels, channels);
        // Colours are rounded to YCbCr and back, and so are their frequencies, by 1 each.
        for (std::size_t i = 0; i < values.size(); ++i)
            EXPECT_NEAR(image.pixels[i], values[i] / 255.0, 3.5 / 255) << channels;
    }
}

struct OtherFormat {
    const char* ending;
    int channels;
    int bits;
    bool is_linear;
    double tolerance;
};

class OtherFormats : public testing::TestWithParam<OtherFormat> {};

TEST_P(OtherFormats, AreDecodedByTheModule) {
    const OtherFormat& format = GetParam();
    const auto [values, image] = decoded(format.ending, format.channels, format.bits);
    ASSERT_EQ(image.channels, format.channels);
    EXPECT_EQ(image.is_linear, format.is_linear);
    ASSERT_EQ(image.pixels.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(image.pixels[i], values[i] / ((1 << format.bits) - 1.0), format.tolerance);
}

// Whole numbers are exact; half floats have 11 bits, RGBE 8 bits for the brightest of a pixel.
INSTANTIATE_TEST_SUITE_P(
    ImageReader, OtherFormats,
    testing::Values(OtherFormat{"tif", 1, 8, false, 1e-7}, OtherFormat{"tif", 3, 16, false, 1e-7},
                    OtherFormat{"tif", 4, 16, false, 1e-7}, OtherFormat{"tga", 3, 8, false, 1e-7},
                    OtherFormat{"tga", 4, 8, false, 1e-7}, OtherFormat{"bmp", 3, 8, false, 1e-7},
                    OtherFormat{"exr", 3, 8, true, 5e-4},
                    OtherFormat{"hdr", 3, 8, true, 1.0 / 256}),
    [](const auto& test) {
        return test.param.ending + std::to_string(test.param.channels) + "x" +
               std::to_string(test.param.bits);
    });

TEST(ImageReader, LinearImagesBecomeTexturesAsTheyAre) {
    const auto [values, image] = decoded("exr", 3);
    const Texture texture(image);
    const Rgb texel = texture.sample(0.5 / image.width, 0.5 / image.height, {});
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(texel[c], values[c] / 255.0, 5e-4 * values[c] / 255.0);
}

TEST(ImageReader, LightAndLengthsAreReadAsTheyAre) {
    const test::SceneFolder folder;
    Film film(2, 1, {0, 0, 2, 1}, {"R", "G", "B", "A"});
    const std::array<float, 3> values{-3.5F, 250.25F, 0.5F};
    for (const int x : {0, 1}) {
        std::ranges::copy(values, film.pixel(x, 0).begin());
        film.pixel(x, 0)[k_alpha] = 1;
    }
    const std::filesystem::path file = folder.path() / "light.exr";
    ExrOptions options;
    options.precision = ExrOptions::Precision::single;
    write_exr(file, film, {}, options);
    const PixelImage light = read_linear_image(file);
    ASSERT_EQ(light.channels, 4);
    EXPECT_TRUE(light.is_linear);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(light.pixels[4 + c], values[c]);
    // Those of a reflectance are between 0 and 1.
    EXPECT_EQ(read_image(file).pixels[0], 0);
    EXPECT_EQ(read_image(file).pixels[1], 1);
    EXPECT_TRUE(
        read_linear_image(folder.write("a.hdr", test::encoded_image("hdr", 1, 1, 3, {90, 80, 70})))
            .is_linear);
    for (const std::string format : {"png", "tif", "bmp"}) {
        const auto whole =
            folder.write("a." + format, test::encoded_image(format, 1, 1, 3, {90, 80, 70}));
        EXPECT_NE(test::message_of<InputError>([&] {
                      read_linear_image(whole);
                  }).find("not an image of linear floating-point values"),
                  std::string::npos)
            << format;
    }
    EXPECT_THROW(read_linear_image(folder.path() / "none.exr"), IoError);
}

// Cut off or damaged anywhere, an OpenEXR is refused with one line, or read as something else.
TEST(ImageReader, OpenExrOfStrangersDoesNoHarm) {
    const test::SceneFolder folder;
    Film film(7, 5, {0, 0, 7, 5}, {"R", "G", "B", "A", "depth.Z"});
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 7; ++x)
            for (std::size_t c = 0; c < 5; ++c)
                film.pixel(x, y)[c] = static_cast<float>(100 * static_cast<int>(c) + 10 * y + x);
    const auto bytes_of = [&](const ExrOptions& options, const char* name) {
        write_exr(folder.path() / name, film, {}, options);
        std::ifstream in(folder.path() / name, std::ios::binary);
        return std::string{std::istreambuf_iterator<char>(in), {}};
    };
    using enum ExrOptions::Precision;
    for (const auto& [options, name] :
         {std::pair{ExrOptions{half, ExrCompression::none}, "halves.exr"},
          std::pair{ExrOptions{single, ExrCompression::zip}, "floats.exr"}}) {
        const std::string whole = bytes_of(options, name);
        const PixelImage image = read_image(encoded_bytes(whole), "a.exr");
        ASSERT_EQ(image.channels, 4);  // not the depth
        const PixelImage light = read_linear_image(folder.path() / name);
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 7; ++x)
                for (std::size_t c = 0; c < 4; ++c)
                    EXPECT_EQ(light.pixels[static_cast<std::size_t>(4 * (7 * y + x)) + c],
                              film.pixel(x, y)[c]);
        const auto try_to_read = [](const std::string& bytes) {
            try {
                read_image(encoded_bytes(bytes), "a.exr");
                return true;
            } catch (const InputError& error) {
                EXPECT_TRUE(std::string(error.what()).starts_with("a.exr: ")) << error.what();
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
                return false;
            }
        };
        for (std::size_t size = 4; size < whole.size(); ++size)
            EXPECT_FALSE(try_to_read(whole.substr(0, size))) << size;
        for (std::size_t at = 4; at < whole.size(); ++at)
            for (const char other : {'\xff', '\x00', '\x7f'}) {
                std::string damaged = whole;
                damaged[at] = other;
                try_to_read(damaged);
            }
    }
    // Of which a part alone is stored.
    write_exr(folder.path() / "part.exr", Film(7, 5, {1, 1, 7, 5}, {"R", "G", "B", "A"}), {});
    EXPECT_NE(test::message_of<InputError>([&] {
                  read_image(folder.path() / "part.exr");
              }).find("not all of the image is stored"),
              std::string::npos);
}

TEST(ImageReader, RefusesOtherImagesThatAreDamaged) {
    for (const std::string format : {"tif", "exr", "hdr", "bmp", "tga", "webp"}) {
        std::vector<int> noise;
        for (unsigned i = 0; i < 64 * 64 * 3; ++i)
            noise.push_back(static_cast<int>(i * i * 2654435761u >> 24));
        const std::string bytes = test::encoded_image(format, 64, 64, 3, noise);
        const std::string name = "x." + format;
        EXPECT_EQ(read_image(encoded_bytes(bytes), name).width, 64);
        // In the pixels and in the header.
        for (const std::size_t size : {bytes.size() / 2, std::size_t{20}}) {
            const std::string message = test::message_of<InputError>(
                [&] { read_image(encoded_bytes(bytes.substr(0, size)), name); });
            EXPECT_TRUE(message.starts_with(name + ": ")) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos);
        }
    }
}

/// A Photoshop document of 4 x 3 pixels of three planes, 0 to 11, 12 to 23 and 24 to 35, in the
/// format's large form (PSB) or the usual one, and where its lengths of parts stand.
struct Psd {
    std::string bytes;
    struct Length {
        std::size_t at, size;
    };
    std::vector<Length> lengths;

    explicit Psd(bool is_large) {
        bytes = "8BPS";
        number(is_large ? 2 : 1, 2);
        bytes.append(6, '\0');
        number(3, 2);  // channels
        number(3, 4);  // rows
        number(4, 4);  // columns
        number(8, 2);  // bits
        number(3, 2);  // RGB
        length(0, 4);  // the palette
        // Two resources of kinds that nobody knows: 4 bytes, then a name, 3 bytes and one to an
        // even number.
        length(4 + 2 + 2 + 4 + 4 + (4 + 2 + 4 + 4 + 4), 4);
        bytes += "8BIM";
        number(4000, 2);
        number(0, 2);  // no name
        length(4, 4);
        number(0, 4);
        bytes += "8BIM";
        number(4001, 2);
        bytes += "\003abc";
        length(3, 4);
        number(0, 4);
        length(0, is_large ? 8 : 4);  // the layers
        number(0, 2);                 // not compressed
        for (char value = 0; value < 36; ++value) bytes += value;
    }
    void number(std::uint64_t value, std::size_t size) {
        for (std::size_t byte = size; byte-- > 0;)
            bytes += static_cast<char>(value >> (8 * byte) & 0xffU);
    }
    void length(std::uint64_t value, std::size_t size) {
        lengths.push_back({bytes.size(), size});
        number(value, size);
    }
};

TEST(ImageReader, RefusesPhotoshopDocumentsThatClaimMoreThanTheyHold) {
    const auto message = [](const std::string& bytes) {
        return test::message_of<InputError>([&] { read_image(encoded_bytes(bytes), "x.psd"); });
    };
    for (const bool is_large : {false, true}) {
        const Psd whole(is_large);
        const PixelImage image = read_image(encoded_bytes(whole.bytes), "x.psd");
        ASSERT_EQ(image.pixels.size(), 36U);
        for (std::size_t pixel = 0; pixel < 12; ++pixel)
            for (std::size_t plane = 0; plane < 3; ++plane)
                EXPECT_EQ(std::lround(image.pixels[3 * pixel + plane] * 255),
                          static_cast<long>(12 * plane + pixel));
        ASSERT_EQ(whole.lengths.size(), 5U);
        for (const auto& [at, size] : whole.lengths)
            // By one, 2 GB and 4 GB.
            for (const std::uint64_t length :
                 {std::uint64_t{whole.bytes.size() - at - size + 1}, std::uint64_t{0x7fffffff},
                  std::uint64_t{0xffffff01}}) {
                std::string bytes = whole.bytes;
                for (std::size_t byte = 0; byte < size; ++byte)
                    bytes[at + byte] = static_cast<char>(length >> (8 * (size - 1 - byte)) & 0xffU);
                EXPECT_EQ(message(bytes),
                          "x.psd: cannot read the PSD image: a part of it is longer than the file; "
                          "save it again, or as PNG")
                    << at << ' ' << length;
            }
        // A thumbnail (1036) in place of the first resource, of fewer bytes than its header has.
        Psd thumbnail = whole;
        thumbnail.bytes.replace(whole.lengths[2].at - 4, 2, "\x04\x0c");
        EXPECT_NE(message(thumbnail.bytes).find("its thumbnail is shorter"), std::string::npos);
        // RGB and Lab of one or two channels, CMYK of three.
        for (const auto& [mode, channels] : {std::pair{3, 1}, {3, 2}, {9, 2}, {4, 3}}) {
            std::string bytes = whole.bytes;
            bytes[13] = static_cast<char>(channels);
            bytes[25] = static_cast<char>(mode);
            EXPECT_NE(message(bytes).find("fewer channels than its colours need"),
                      std::string::npos);
        }
        // Nine compressed rows, of which the last one says that it is longer than what follows.
        std::string compressed = whole.bytes;
        compressed.resize(compressed.size() - 36);
        compressed.back() = 1;
        for (int row = 0; row < 9; ++row) {
            if (is_large) compressed += std::string(2, row == 8 ? '\xff' : '\0');
            compressed += std::string{'\0', row == 8 ? '\xff' : '\1'};
        }
        compressed += std::string(36, '\0');
        EXPECT_NE(message(compressed).find("a part of it is longer"), std::string::npos);
    }
}

TEST(ImageReader, RefusesImagesThatEndEarly) {
    for (const std::string format : {"png", "jpg"}) {
        std::vector<int> noise;
        for (unsigned i = 0; i < 64 * 64 * 3; ++i)
            noise.push_back(static_cast<int>(i * i * 2654435761u >> 24));
        const std::string bytes = test::encoded_image(format, 64, 64, 3, noise);
        EXPECT_EQ(read_image(encoded_bytes(bytes), "x").width, 64);
        for (const std::size_t size : {bytes.size() / 2, bytes.size() / 10, std::size_t{20}})
            EXPECT_THROW(read_image(encoded_bytes(bytes.substr(0, size)), "x"), InputError)
                << format << " " << size;
    }
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

TEST_F(ImageHeader, IsOfTheSameStorage) {
    using enum ExrOptions::Precision;
    const auto stored = [&](ExrOptions::Precision precision, const std::string& light) {
        const std::vector<std::string> names{"R", "G", "B", "A", light, "depth.Z"};
        write_exr(file_, Film(8, 6, window_, names), {}, {precision, ExrCompression::zips});
        const auto fits = [&](ExrOptions::Precision requested, ExrCompression compression) {
            return has_header_of(file_, {8, 6, window_, names, {requested, compression}}, {});
        };
        EXPECT_FALSE(fits(precision, ExrCompression::zip));
        EXPECT_TRUE(fits(precision, ExrCompression::zips));
        return std::vector<bool>{fits(automatic, ExrCompression::zips),
                                 fits(half, ExrCompression::zips),
                                 fits(single, ExrCompression::zips)};
    };
    // Whether an image of the total alone is half follows from its pixels.
    EXPECT_EQ(stored(half, "total.540nm"), (std::vector<bool>{true, true, false}));
    EXPECT_EQ(stored(single, "total.540nm"), (std::vector<bool>{true, false, true}));
    EXPECT_EQ(stored(half, "direct.R"), (std::vector<bool>{false, true, false}));
    EXPECT_EQ(stored(single, "direct.R"), (std::vector<bool>{true, false, true}));
    EXPECT_EQ(stored(automatic, "direct.R"), (std::vector<bool>{true, false, true}));
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
    // The header of an image without samples, cut off or damaged anywhere.
    std::ifstream in(file_, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), {}};
    const std::size_t end = whole.find("screenWindowWidth");
    for (std::size_t size = 0; size < end; ++size)
        EXPECT_FALSE(has_header_of(folder_.write("cut.exr", whole.substr(0, size)), layout, {}));
    for (std::size_t at = 0; at < end; ++at) {
        std::string damaged = whole;
        damaged[at] = '\xff';
        has_header_of(folder_.write("damaged.exr", damaged), layout, {});  // must return
    }
}

}  // namespace
}  // namespace uw
