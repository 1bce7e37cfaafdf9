// ctest labels: unit analytic
#include "core/image/colour.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/image/spectral_bands.h"

namespace uw {
namespace {

Spectrum spectrum_of(const std::vector<double>& values) {
    Spectrum s{};
    std::copy(values.begin(), values.end(), s.begin());
    return s;
}

TEST(Colour, ThreeBandsAreRgbUnchanged) {
    const std::vector<double> bands{620, 540, 450};
    const LinearRgb rgb = BandColour(bands)(spectrum_of({0.1, -2.5, 1e-9}));
    EXPECT_EQ(rgb, (LinearRgb{0.1, -2.5, 1e-9}));
}

TEST(Colour, OneBandIsGrey) {
    const std::vector<double> bands{532};
    EXPECT_EQ(BandColour(bands)(spectrum_of({0.7})), (LinearRgb{0.7, 0.7, 0.7}));
}

TEST(Colour, EqualEnergyIsWhite) {
    const std::vector<std::vector<double>> band_sets{
        {480, 560}, {620, 450, 540, 500}, {400, 450, 500, 550, 600, 650, 700}, {425.5, 533.3}};
    for (const auto& bands : band_sets) {
        const BandColour colour(bands);
        const LinearRgb rgb = colour(spectrum_of(std::vector<double>(bands.size(), 1.0)));
        // The matrix and the white point are given to 10 digits.
        for (const double c : rgb) EXPECT_NEAR(c, 1, 1e-6);
        EXPECT_NEAR(luminance(rgb), 1, 1e-6);
        EXPECT_EQ(colour.warning(), "");
    }
}

TEST(Colour, FollowsCie1931) {
    // Unequal steps, out of order; intervals from halfway to halfway, as far out as in at the ends.
    const std::vector<double> bands{600, 450, 550, 480};
    const std::array<std::array<int, 2>, 4> interval{
        {{575, 625}, {435, 465}, {515, 575}, {465, 515}}};
    std::array<double, 4> width{};
    std::array<std::array<double, 3>, 4> cmf{};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto [begin, end] = interval[i];
        width[i] = end - begin;
        // The trapezoid rule over 1 nm is exact for a table that is linear over 5.
        for (int nm = begin; nm <= end; ++nm) {
            const Xyz at = cie1931_matching_functions(nm);
            const double weight = (nm == begin || nm == end ? 0.5 : 1.0) / width[i];
            cmf[i][0] += weight * at.x;
            cmf[i][1] += weight * at.y;
            cmf[i][2] += weight * at.z;
        }
    }
    const std::vector<double> radiance{0.2, 0.9, 0.5, 1.4};
    std::array<double, 3> xyz{}, white{};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            xyz[c] += width[i] * cmf[i][c] * radiance[i];
            white[c] += width[i] * cmf[i][c];
        }
    }
    // Back from RGB with the forward matrix of IEC 61966-2-1; its rows sum to the D65 white.
    const LinearRgb rgb = BandColour(bands)(spectrum_of(radiance));
    const std::array<std::array<double, 3>, 3> xyz_from_rgb{
        {{0.4123907993, 0.3575843394, 0.1804807884},
         {0.2126390059, 0.7151686788, 0.0721923154},
         {0.0193308187, 0.1191947798, 0.9505321522}}};
    for (std::size_t row = 0; row < 3; ++row) {
        const auto& m = xyz_from_rgb[row];
        const double d65 = m[0] + m[1] + m[2];
        const double shown = m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2];
        // Means are taken over half nanometres.
        EXPECT_NEAR(shown / d65, xyz[row] / white[row], 2e-5) << row;
    }
}

TEST(Colour, PureColoursLieOutsideTheGamutAndKeepTheirSign) {
    const std::vector<double> bands{450, 500, 550, 600, 650};
    const LinearRgb cyan = BandColour(bands)(spectrum_of({0, 1, 0, 0, 0}));
    EXPECT_LT(cyan[0], 0);
    EXPECT_GT(cyan[1], 0);
    const LinearRgb red = BandColour(bands)(spectrum_of({0, 0, 0, 0, 1}));
    EXPECT_GT(red[0], 0);
    EXPECT_LT(red[1], 0);
}

TEST(Colour, NeverSilentlyBlack) {
    for (const std::vector<double>& bands :
         {std::vector<double>{850, 900}, {700, 720, 740, 760}, {550, 550}}) {
        const BandColour colour(bands);
        EXPECT_NE(colour.warning(), "");
        for (const double c : colour(spectrum_of(std::vector<double>(bands.size(), 0.5)))) {
            EXPECT_NEAR(c, 0.5, 1e-15);
        }
    }
}

TEST(Colour, SrgbTransferFunction) {
    EXPECT_EQ(srgb_encode(-1), 0);
    EXPECT_EQ(srgb_encode(std::nan("")), 0);
    EXPECT_EQ(srgb_encode(7), 1);
    EXPECT_NEAR(srgb_encode(0.002), 0.02584, 1e-12);
    EXPECT_NEAR(srgb_encode(0.21404114), 0.5, 1e-7);  // known: mid grey
    EXPECT_NEAR(luminance({0, 1, 0}), 0.7152, 1e-4);
}

TEST(Colour, BytesAreTheNearestToSrgb) {
    const SrgbBytes& srgb_byte = srgb_bytes();
    for (int i = -100; i < 100'100; ++i) {
        const double linear = 1e-5 * i;
        ASSERT_EQ(srgb_byte(linear), std::lround(255 * srgb_encode(linear))) << linear;
    }
    EXPECT_EQ(srgb_byte(std::nan("")), 0);
    EXPECT_EQ(srgb_byte(std::numeric_limits<double>::infinity()), 255);
    EXPECT_EQ(srgb_byte(std::nextafter(1.0, 0.0)), 255);
    EXPECT_EQ(srgb_byte(std::numeric_limits<double>::denorm_min()), 0);
}

}  // namespace
}  // namespace uw
