// ctest labels: unit analytic
#include "core/image/colour.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/image/spectral_bands.h"
#include "tests/support/ies_files.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

LampSpectrumDesc spectrum_desc(LampSpectrumDesc::Type type, const std::string& name = "") {
    LampSpectrumDesc desc;
    desc.type = type;
    desc.name = name;
    return desc;
}

Spectrum light_of(const LampSpectrumDesc& desc, const std::vector<double>& bands) {
    const PerBand values = band_values(make_lamp_spectrum(desc), 1, band_intervals(bands));
    Spectrum light{};
    std::copy(values.begin(), values.end(), light.begin());
    return light;
}

void expect_grey(const LinearRgb& rgb, double tolerance) {
    EXPECT_NEAR(rgb[0] / rgb[1], 1, tolerance);
    EXPECT_NEAR(rgb[2] / rgb[1], 1, tolerance);
}

class ColourResponse : public testing::Test {
  protected:
    BandColour colour(const std::vector<double>& bands) { return make_band_colour(desc_, bands); }

    test::SceneFolder folder_;
    ColourDesc desc_;
    const std::vector<double> bands_ = test::steps(400, 700, 20);  // 16
};

TEST_F(ColourResponse, DaylightIsTheWhiteOfSrgb) {
    // Without a white to balance for, D65 is what it is: the white of sRGB. 16 bands see its steps
    // of 10 nm coarsely.
    desc_.response = ColourDesc::Response::cie;
    desc_.raw = true;
    const Spectrum daylight = light_of(spectrum_desc(LampSpectrumDesc::Type::d65), bands_);
    expect_grey(colour(bands_)(daylight), 0.01);
    Spectrum flat{};
    std::fill(flat.begin(), flat.begin() + 16, 1.0);
    // Known: equal energy in sRGB is reddish, R 1.2048, G 0.9483, B 0.9088 for Y = 1.
    const LinearRgb equal_energy = colour(bands_)(flat);
    EXPECT_NEAR(equal_energy[0], 1.2048, 0.01);
    EXPECT_NEAR(equal_energy[1], 0.9483, 0.01);
    EXPECT_NEAR(equal_energy[2], 0.9088, 0.01);
}

TEST_F(ColourResponse, TheLightThatIsWhiteIsGrey) {
    const LampSpectrumDesc led = spectrum_desc(LampSpectrumDesc::Type::led, "LED-B3");
    const Spectrum light = light_of(led, bands_);
    LinearRgb warm = colour(bands_)(light);
    EXPECT_GT(warm[0], 1.2 * warm[2]);  // 4103 K
    desc_.white = led;
    expect_grey(colour(bands_)(light), 1e-9);
    desc_.response = ColourDesc::Response::camera;
    desc_.file = std::string(UWVDB_SOURCE_DIR) + "/assets/cameras/nikon_d5100.csv";
    expect_grey(colour(bands_)(light), 1e-12);
}

TEST_F(ColourResponse, ACamerasCurvesByHand) {
    desc_.response = ColourDesc::Response::camera;
    desc_.file =
        folder_.write("camera.csv", "wavelength_nm,r,g,b\n440,0,1,8\n540,1,4,2\n640,4,2,1\n");
    // Bands of 440..540 and 540..640 nm: means 0.5 and 2.5, 2.5 and 3, 5 and 1.5.
    const std::vector<double> bands{490, 590};
    desc_.raw = true;
    Spectrum light{};
    light[0] = 2;
    light[1] = 0.5;
    const LinearRgb raw = colour(bands)(light);
    EXPECT_NEAR(raw[0], (2 * 0.5 + 0.5 * 2.5) / 5.5, 1e-12);
    EXPECT_NEAR(raw[1], (2 * 2.5 + 0.5 * 3) / 5.5, 1e-12);
    EXPECT_NEAR(raw[2], (2 * 5 + 0.5 * 1.5) / 5.5, 1e-12);
    desc_.raw = false;  // flat light is white
    const LinearRgb balanced = colour(bands)(light);
    EXPECT_NEAR(balanced[0], (2 * 0.5 + 0.5 * 2.5) / 3, 1e-12);
    EXPECT_NEAR(balanced[1], raw[1], 1e-12);
    EXPECT_NEAR(balanced[2], (2 * 5 + 0.5 * 1.5) / 6.5, 1e-12);
}

TEST_F(ColourResponse, ThreeBandsByRequestOnly) {
    Spectrum light{};
    light[0] = 1;
    const std::vector<double> bands{620, 540, 450};
    EXPECT_EQ(colour(bands)(light), (LinearRgb{1, 0, 0}));
    desc_.response = ColourDesc::Response::cie;
    const LinearRgb seen = colour(bands)(light);
    EXPECT_GT(seen[0], 1);
    EXPECT_NE(seen[1], 0);
}

TEST_F(ColourResponse, RefusesWhatShowsNothing) {
    desc_.response = ColourDesc::Response::camera;
    const auto expect_refused = [&](const std::string& table, const std::vector<double>& bands) {
        desc_.file = folder_.write("camera.csv", table);
        EXPECT_THROW(colour(bands), InputError) << table;
    };
    const std::string good = "wavelength_nm,r,g,b\n400,1,1,1\n700,1,1,1\n";
    expect_refused(good, {800, 900});
    expect_refused("wavelength_nm,r,g\n400,1,1\n700,1,1\n", bands_);
    expect_refused("wavelength_nm,r,g,b\n400,0,1,1\n700,0,1,1\n", bands_);
    expect_refused("", bands_);
    desc_.white = spectrum_desc(LampSpectrumDesc::Type::flat);
    expect_refused(good, {500});
    desc_.file = folder_.path() / "none.csv";
    EXPECT_THROW(colour(bands_), IoError);
}

}  // namespace
}  // namespace uw
