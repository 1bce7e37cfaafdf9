// ctest labels: unit analytic
#include "core/image/development.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/error.h"
#include "core/image/camera_sensor.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

constexpr int k_width = 9, k_height = 7;
constexpr PixelWindow k_whole{0, 0, k_width, k_height};

/// A film with the numbers of a sensor.
Film film_of(SensorMosaic mosaic, const std::function<double(int x, int y, std::size_t c)>& number,
             const PixelWindow& window = k_whole) {
    std::vector<std::string> names{"R", "G", "B", "A", "depth.Z"};
    if (value_count(mosaic) == 1)
        names.emplace_back("sensor.V");
    else
        names.insert(names.end(), {"sensor.R", "sensor.G", "sensor.B"});
    Film film(k_width, k_height, window, names);
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
            for (std::size_t c = 0; c < value_count(mosaic); ++c)
                film.pixel(x, y)[5 + c] = static_cast<float>(
                    number(x, y, is_bayer(mosaic) ? colour_at(mosaic, x, y) : c));
    return film;
}

SensorDesc developing(SensorMosaic mosaic) {
    SensorDesc desc;
    desc.mosaic = mosaic;
    desc.image.is_raw = false;
    desc.image.bits = 16;
    desc.bit_depth = 12;
    desc.black_level = 95;  // so that white is 4000 above it
    return desc;
}

std::uint16_t value_at(const DigitalImage& image, int x, int y, int c) {
    return image.values[static_cast<std::size_t>((y * image.width + x) * image.channels + c)];
}

std::uint16_t of_fraction(double fraction) {
    return static_cast<std::uint16_t>(std::lround(65535 * fraction));
}

TEST(Development, RawKeepsTheNumbersInTheUpperBits) {
    for (const auto& [bits, stored, factor] :
         {std::array{8, 8, 1}, {10, 16, 64}, {12, 16, 16}, {16, 16, 1}}) {
        SensorDesc desc;
        desc.bit_depth = bits;
        const auto number = [](int x, int y, std::size_t) { return 17.0 * x + 3.0 * y; };
        const DigitalImage image = Development(desc)(film_of(desc.mosaic, number), {2, 1, 9, 6});
        EXPECT_EQ(image.bits, stored);
        EXPECT_EQ(image.channels, 1);
        ASSERT_EQ(image.values.size(), 7U * 5U);
        for (int y = 1; y < 6; ++y)
            for (int x = 2; x < 9; ++x)
                EXPECT_EQ(value_at(image, x - 2, y - 1, 0), factor * (17 * x + 3 * y));
    }
}

/// Bilinear interpolation is exact for what is linear, except at the image's border, where the
/// nearest pixels lie on one side.
TEST(Development, DemosaicsLinearColoursExactlyInEveryPattern) {
    const auto light = [](int x, int y, std::size_t c) {
        return 95 + 400.0 * static_cast<double>(c + 1) + 40.0 * x - 20.0 * y;
    };
    for (const SensorMosaic mosaic :
         {SensorMosaic::rggb, SensorMosaic::bggr, SensorMosaic::grbg, SensorMosaic::gbrg}) {
        const DigitalImage image = Development(developing(mosaic))(film_of(mosaic, light), k_whole);
        ASSERT_EQ(image.channels, 3);
        for (int y = 1; y + 1 < k_height; ++y)
            for (int x = 1; x + 1 < k_width; ++x)
                for (std::size_t c = 0; c < 3; ++c)
                    EXPECT_EQ(value_at(image, x, y, static_cast<int>(c)),
                              of_fraction((light(x, y, c) - 95) / 4000));
    }
}

TEST(Development, DemosaicsOneColourAsThatColourUpToTheBorder) {
    const auto colour = [](int, int, std::size_t c) {
        return 95 + 1000.0 * static_cast<double>(c);
    };
    const auto mosaic = SensorMosaic::gbrg;
    const DigitalImage image = Development(developing(mosaic))(film_of(mosaic, colour), k_whole);
    for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < k_width; ++x)
            for (int c = 0; c < 3; ++c) EXPECT_EQ(value_at(image, x, y, c), of_fraction(0.25 * c));
}

TEST(Development, APartWithItsMarginIsAPartOfTheWhole) {
    const auto mosaic = SensorMosaic::grbg;
    const auto uneven = [](int x, int y, std::size_t c) {
        return std::fmod(997.0 * (x + 13 * y) + 31.0 * static_cast<double>(c), 4000);
    };
    const Development develop(developing(mosaic));
    ASSERT_EQ(develop.margin(), 1);
    const DigitalImage whole = develop(film_of(mosaic, uneven), k_whole);
    const DigitalImage part = develop(film_of(mosaic, uneven, {2, 0, 7, 5}), {3, 0, 6, 4});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 3; ++x)
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(value_at(part, x, y, c), value_at(whole, x + 3, y, c));
}

TEST(Development, GainsAreThoseGivenOrThoseOfAGreyMean) {
    const auto mosaic = SensorMosaic::rggb;
    const auto greenish = [](int, int, std::size_t c) { return 95 + (c == 1 ? 1600 : 800.0); };
    SensorDesc desc = developing(mosaic);
    desc.image.white_balance = DevelopmentDesc::Gains{1.5, 1, 0.5};
    DigitalImage image = Development(desc)(film_of(mosaic, greenish), k_whole);
    EXPECT_EQ(value_at(image, 3, 3, 0), of_fraction(0.3));
    EXPECT_EQ(value_at(image, 3, 3, 1), of_fraction(0.4));
    EXPECT_EQ(value_at(image, 3, 3, 2), of_fraction(0.1));
    desc.image.white_balance = DevelopmentDesc::GreyWorld{};
    image = Development(desc)(film_of(mosaic, greenish), k_whole);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(value_at(image, 3, 3, c), of_fraction(0.4));
    desc.image.demosaic = false;
    image = Development(desc)(film_of(mosaic, greenish), k_whole);
    ASSERT_EQ(image.channels, 1);
    for (const std::uint16_t value : image.values) EXPECT_EQ(value, of_fraction(0.4));
}

TEST(Development, LimitsWhatIsBelowBlackAndAboveWhite) {
    SensorDesc desc = developing(SensorMosaic::three);
    desc.image.white_balance = DevelopmentDesc::Gains{2, 1, 1};
    const auto number = [](int x, int, std::size_t) { return x == 0 ? 20.0 : 4095.0; };
    const DigitalImage image = Development(desc)(film_of(desc.mosaic, number), k_whole);
    EXPECT_EQ(value_at(image, 0, 0, 0), 0);
    EXPECT_EQ(value_at(image, 1, 0, 0), 65535);
    EXPECT_EQ(value_at(image, 1, 0, 1), 65535);
}

/// Decoded by the standards' own inverses, what is stored is the light again, to half a step.
TEST(Development, ResponseCurvesComeBack) {
    const test::SceneFolder folder;
    struct Case {
        ResponseCurveDesc desc;
        std::function<double(double)> decode;
    };
    using Type = ResponseCurveDesc::Type;
    const auto srgb = [](double v) {  // IEC 61966-2-1
        return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    };
    const auto table = [](double v) {
        return v < 0.6 ? v / 0.6 * 0.25 : 0.25 + (v - 0.6) / 0.4 * 0.75;
    };
    const std::array<Case, 4> cases{
        {{{Type::linear, 1, {}, ""}, [](double v) { return v; }},
         {{Type::srgb, 1, {}, ""}, srgb},
         {{Type::gamma, 2.2, {}, ""}, [](double v) { return std::pow(v, 2.2); }},
         {{Type::file, 1, folder.write("curve.csv", "input,output\n0,0\n0.25,0.6\n1,1\n"), ""},
          table}}};
    const auto ramp = [](int x, int y, std::size_t) { return 95 + 4000.0 * (x + 9 * y) / 62; };
    for (const Case& curve : cases) {
        SensorDesc desc = developing(SensorMosaic::mono);
        desc.image.response = curve.desc;
        desc.image.bits = 8;
        const DigitalImage image = Development(desc)(film_of(desc.mosaic, ramp), k_whole);
        EXPECT_EQ(image.is_srgb, curve.desc.type == Type::srgb);
        EXPECT_EQ(image.bits, 8);
        for (int i = 0; i < 63; ++i) {
            const double value = image.values[static_cast<std::size_t>(i)];
            EXPECT_LE(curve.decode(std::max(0.0, value - 0.501) / 255), i / 62.0);
            EXPECT_GE(curve.decode(std::min(255.0, value + 0.501) / 255), i / 62.0);
        }
    }
    for (const char* text : {"input,output\n0,0\n0.5,0.8\n", "input,output\n0,0\n0.5,0.8\n1,0.7\n",
                             "input,output\n0,0\n1,255\n"}) {
        const ResponseCurveDesc desc{Type::file, 1, folder.write("bad.csv", text), "here"};
        EXPECT_THROW(ResponseCurve{desc}, InputError) << text;
    }
}

}  // namespace
}  // namespace uw
