// ctest labels: unit analytic
#include "core/light/lamp_factory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/image/spectral_bands.h"
#include "tests/support/ies_files.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

using std::numbers::pi;

/// As many as a scene may have: 12.5 nm wide, 380 to 780 nm.
std::vector<double> fine_bands() {
    return test::steps(386.25, 773.75, 12.5);
}

/// Lumens per steradian of intensities per band, each its band's whole [W/sr].
double candelas_of(const Spectrum& intensity, const std::vector<double>& bands) {
    double sum = 0;
    for (std::size_t i = 0; i < bands.size(); ++i)
        sum += 683 * cie1931_matching_functions(bands[i]).y * intensity[i];
    return sum;
}

double sum_of(const Spectrum& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum;
}

class LampFactory : public testing::Test {
  protected:
    Lamp make(const std::vector<double>& bands) { return make_lamp(desc_, {}, bands, warnings_); }

    void use_ies(double lumens, double candelas) {
        test::IesWriter writer;
        writer.lumens = lumens;
        writer.polar = {0, 180};
        writer.candelas = [&](double, double) { return candelas; };
        desc_.profile = IesProfileDesc{folder_.write("lamp.ies", writer.text())};
    }
    void use_led() {
        desc_.spectrum = LampSpectrumDesc{};
        desc_.spectrum->type = LampSpectrumDesc::Type::led;
        desc_.spectrum->name = "LED-B4";
    }

    test::SceneFolder folder_;
    LampDesc desc_;
    std::vector<std::string> warnings_;
};

TEST_F(LampFactory, LumensAreTheFluxOfTheBands) {
    use_led();
    desc_.lumens = 6000;
    const Lamp lamp = make(fine_bands());
    // Isotropic: 6000 / 4 pi cd. The sum over 12.5 nm is within 0.5 % of the integral: the LED's
    // blue line is as narrow as two of its steps, but V is small there.
    EXPECT_NEAR(candelas_of(lamp.axis_intensity(), fine_bands()), 6000 / (4 * pi),
                0.005 * 6000 / (4 * pi));
}

TEST_F(LampFactory, WattsOfASpectrumAreAllOfIt) {
    use_led();
    desc_.power = PerBand{100};
    EXPECT_NEAR(sum_of(make(fine_bands()).axis_intensity()), 100 / (4 * pi), 1e-9);
    desc_.power.reset();
    desc_.intensity = PerBand{30};
    EXPECT_NEAR(sum_of(make(fine_bands()).axis_intensity()), 30, 1e-9);
}

TEST_F(LampFactory, CandelasBecomeWattsByTheSpectrum) {
    use_ies(-1, 500);
    use_led();
    EXPECT_NEAR(candelas_of(make(fine_bands()).axis_intensity(), fine_bands()), 500, 2.5);
    EXPECT_TRUE(warnings_.empty());
    // Without one it is flat: 683 int V / 400 nm = 182.5 lm/W, 1 in 32 in each of the bands.
    desc_.spectrum.reset();
    const Lamp flat = make(fine_bands());
    EXPECT_NEAR(flat.axis_intensity()[7], 500 / 182.46 / 32, 1e-3 * 500 / 182.46 / 32);
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("flat spectrum"), std::string::npos);
}

TEST_F(LampFactory, WattsOverrideTheFilesCandelas) {
    use_ies(-1, 500);
    desc_.intensity = PerBand{1, 2};
    const Lamp lamp = make({500, 600});
    EXPECT_EQ(lamp.axis_intensity()[0], 1);
    EXPECT_EQ(lamp.axis_intensity()[1], 2);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(LampFactory, FluxIsCheckedAgainstTheLumens) {
    desc_.intensity = PerBand{1, 1};
    const double flux = 4 * pi * 500;
    const auto warnings_with = [&](double lumens) {
        warnings_.clear();
        use_ies(lumens, 500);
        make({500, 600});
        return warnings_.size();
    };
    EXPECT_EQ(warnings_with(flux), 0U);
    EXPECT_EQ(warnings_with(flux / 0.3), 0U);   // a luminaire that keeps 70 % for itself
    EXPECT_EQ(warnings_with(flux / 1.05), 1U);  // more than its lamps give
    EXPECT_EQ(warnings_with(flux * 1000), 1U);  // candelas per 1000 lm
    EXPECT_EQ(warnings_with(-1), 0U);           // absolute photometry
}

TEST_F(LampFactory, PowerIsTheIntegralOfTheIntensity) {
    desc_.power = PerBand{10, 20};
    const auto intensity = [&](const LampProfileDesc& profile) {
        desc_.profile = profile;
        return make({500, 600}).axis_intensity();
    };
    EXPECT_NEAR(intensity(IsotropicProfileDesc{})[0], 10 / (4 * pi), 1e-12);
    EXPECT_NEAR(intensity(IsotropicProfileDesc{})[1], 20 / (4 * pi), 1e-12);
    // A hard edge: a cone of 2 pi (1 - cos 30 deg) sr.
    EXPECT_NEAR(intensity(SpotProfileDesc{60})[0], 10 / (2 * pi * (1 - std::cos(pi / 6))), 1e-12);
    EXPECT_NEAR(intensity(CosineProfileDesc{120})[0], 10 / pi, 1e-12);  // Lambert: Phi = pi I
}

TEST_F(LampFactory, PlacesTheLampInItsFrame) {
    desc_.intensity = PerBand{1};
    desc_.position = {1, 0, 0};
    desc_.profile = SpotProfileDesc{60};
    const auto moved = Affine::translation({0, 0, 5}) * Affine::rotation_xyz_degrees({0, 180, 0});
    const std::vector<double> bands{540};
    const Lamp with_camera = make_lamp(desc_, moved, bands, warnings_);
    EXPECT_NEAR(distance(with_camera.position(), {-1, 0, 5}), 0, 1e-12);
    EXPECT_EQ(with_camera.relative_intensity({0, 0, -1}), 1);
    desc_.fixed_to_camera = false;
    const Lamp in_world = make_lamp(desc_, moved, bands, warnings_);
    EXPECT_NEAR(distance(in_world.position(), {1, 0, 0}), 0, 1e-12);
    EXPECT_EQ(in_world.relative_intensity({0, 0, 1}), 1);
    desc_.world_from_mount = moved;
    const Lamp mounted = make_lamp(desc_, {}, bands, warnings_);
    EXPECT_NEAR(distance(mounted.position(), {-1, 0, 5}), 0, 1e-12);
    EXPECT_EQ(mounted.relative_intensity({0, 0, -1}), 1);
}

TEST_F(LampFactory, RefusesWhatHasNoAnswer) {
    use_led();
    desc_.lumens = 100;
    EXPECT_THROW(make({532}), InputError);       // one band has no width
    EXPECT_THROW(make({900, 950}), InputError);  // LED-B4 ends at 780 nm
    desc_.spectrum->type = LampSpectrumDesc::Type::file;
    desc_.spectrum->file = folder_.write("ir.csv", "wavelength_nm,p\n850,1\n950,1\n");
    EXPECT_THROW(make({900, 950}), InputError);  // lumens of what nobody sees
    desc_.lumens.reset();
    desc_.power = PerBand{10};
    EXPECT_NO_THROW(make({900, 950}));
}

}  // namespace
}  // namespace uw
