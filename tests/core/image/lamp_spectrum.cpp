// ctest labels: unit analytic
#include "core/image/spectral_bands.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/base/error.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

LampSpectrum spectrum(LampSpectrumDesc::Type type, double temperature = 0) {
    LampSpectrumDesc desc;
    desc.type = type;
    desc.temperature = temperature;
    return make_lamp_spectrum(desc);
}

LampSpectrum cie_led(const std::string& name) {
    LampSpectrumDesc desc;
    desc.type = LampSpectrumDesc::Type::led;
    desc.name = name;
    return make_lamp_spectrum(desc);
}

/// Chromaticity x, y by the sum over 5 nm that CIE 015 prescribes.
std::array<double, 2> chromaticity(const LampSpectrum& light) {
    double x = 0, y = 0, z = 0;
    for (int nm = 360; nm <= 830; nm += 5) {
        const Xyz cmf = cie1931_matching_functions(nm);
        const double s = light.density.covers(nm) ? light.density.value(nm) : 0;
        x += cmf.x * s;
        y += cmf.y * s;
        z += cmf.z * s;
    }
    return {x / (x + y + z), y / (x + y + z)};
}

void expect_chromaticity(const LampSpectrum& light, double x, double y, double tolerance) {
    EXPECT_NEAR(chromaticity(light)[0], x, tolerance);
    EXPECT_NEAR(chromaticity(light)[1], y, tolerance);
}

TEST(LampSpectrum, BlackbodiesLieOnThePlanckianLocus) {
    using enum LampSpectrumDesc::Type;
    // CIE illuminant A is a blackbody of 2855.5 K on the scale of today.
    expect_chromaticity(spectrum(blackbody, 2855.5), 0.4476, 0.4074, 1e-4);
    // Published points of the locus (Wyszecki and Stiles, table 1(3.11)).
    expect_chromaticity(spectrum(blackbody, 4000), 0.3805, 0.3768, 2e-4);
    expect_chromaticity(spectrum(blackbody, 6500), 0.3135, 0.3237, 2e-4);
    expect_chromaticity(spectrum(blackbody, 10000), 0.2807, 0.2884, 2e-4);
}

TEST(LampSpectrum, TablesOfTheCie) {
    using enum LampSpectrumDesc::Type;
    expect_chromaticity(spectrum(d65), 0.3127, 0.3290, 1e-4);
    // CIE 015:2018, table 12.
    expect_chromaticity(cie_led("LED-B1"), 0.4560, 0.4078, 2e-4);
    expect_chromaticity(cie_led("LED-B3"), 0.3756, 0.3723, 2e-4);
    expect_chromaticity(cie_led("LED-B5"), 0.3118, 0.3236, 2e-4);
    expect_chromaticity(spectrum(flat), 1.0 / 3, 1.0 / 3, 2e-4);
    EXPECT_THROW(cie_led("LED-B9"), InputError);
}

TEST(LampSpectrum, ABlackbodysTotalIsStefanAndBoltzmanns) {
    // The curve from 100 to 2000 nm lacks what lies beyond: of 6000 K, by tables of the blackbody's
    // fractions (lambda T = 12000 um K), 5.5 %.
    const LampSpectrum sun = spectrum(LampSpectrumDesc::Type::blackbody, 6000);
    EXPECT_NEAR(integral(sun.density, 0, 1e9) / sun.total, 0.9451, 2e-4);
    // Luminous efficacy of 6640 K, the highest of all blackbodies: 95 lm/W.
    EXPECT_NEAR(luminous_efficacy(spectrum(LampSpectrumDesc::Type::blackbody, 6640)), 95.0, 0.5);
}

TEST(LampSpectrum, LuminousEfficacyInClosedForm) {
    // Flat light: the published integral of V, 106.857 nm.
    EXPECT_NEAR(luminous_efficacy(spectrum(LampSpectrumDesc::Type::flat)), 683 * 106.857 / 400,
                0.05);
    // Light of one line of 555 nm, as narrow as a table can say: 683 lm/W.
    const LampSpectrum line{{{554.99, 555, 555.01}, {0, 1, 0}}, 0.01};
    EXPECT_NEAR(luminous_efficacy(line), 683, 0.01);
}

TEST(LampSpectrum, BandsShareOutTheWhole) {
    const LampSpectrum white = cie_led("LED-B4");
    std::vector<double> bands;
    for (int nm = 385; nm < 780; nm += 10) bands.push_back(nm);
    const PerBand values = band_values(white, 100, band_intervals(bands));
    double sum = 0;
    for (const double value : values) sum += value;
    EXPECT_NEAR(sum, 100, 1e-9);  // they cover 380 to 780 nm, all of the table
    // One of them by hand: 535 nm, 530 to 540 nm, halves of two lines.
    const SampledCurve& s = white.density;
    const double by_hand = 2.5 * (s.value(530) + 2 * s.value(535) + s.value(540));
    EXPECT_NEAR(values[15], 100 * by_hand / white.total, 1e-9);
}

TEST(LampSpectrum, FlatLightIsTheSameInBandsOfAnyWidth) {
    const std::vector<double> bands{620, 450, 540, 480};
    const std::vector<BandInterval> intervals = band_intervals(bands);
    EXPECT_EQ(intervals[0].begin, 580);
    EXPECT_EQ(intervals[0].end, 660);
    EXPECT_EQ(intervals[1].begin, 435);
    EXPECT_EQ(intervals[1].end, 465);
    EXPECT_EQ(intervals[3].begin, 465);
    EXPECT_EQ(intervals[3].end, 510);
    const double mean = (80 + 30 + 70 + 45) / 4.0;
    const PerBand values = band_values(spectrum(LampSpectrumDesc::Type::flat), 400, intervals);
    for (const double value : values) EXPECT_NEAR(value, mean, 1e-9);  // 1 W/nm
}

TEST(LampSpectrum, FilesOfUsers) {
    const test::SceneFolder folder;
    LampSpectrumDesc desc;
    desc.type = LampSpectrumDesc::Type::file;
    desc.where = "lamp.spectrum";
    desc.file = folder.write("one.csv", "# of a meter\nwavelength_nm,power\n400,1\n500,3\n");
    EXPECT_NEAR(make_lamp_spectrum(desc).total, 200, 1e-12);
    desc.file = folder.write("two.csv", "wavelength_nm,a,b\n400,1,2\n500,3,2\n");
    EXPECT_THROW(make_lamp_spectrum(desc), InputError);
    desc.column = "b";
    EXPECT_NEAR(make_lamp_spectrum(desc).total, 200, 1e-12);
    for (const char* const wrong :
         {"wavelength_nm,b\n400,1\n", "wavelength_nm,b\n400,-1\n500,1\n",
          "wavelength_nm,b\n400,0\n500,0\n", "wavelength_nm,b\n0.4,1\n0.5,1\n",
          "wavelength_nm,b\n500,1\n400,1\n", "wavelength_nm,b\n400,nan\n500,1\n", "", "nm\n4\n"}) {
        desc.file = folder.write("wrong.csv", wrong);
        EXPECT_THROW(make_lamp_spectrum(desc), InputError) << wrong;
    }
    desc.file = folder.path() / "none.csv";
    EXPECT_THROW(make_lamp_spectrum(desc), IoError);
}

}  // namespace
}  // namespace uw
