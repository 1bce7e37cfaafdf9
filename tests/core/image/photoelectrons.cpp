// ctest labels: unit analytic
#include "core/image/camera_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

/// EMVA standard 1288, release 4.0, equation (2): photons = 5.034e24 A t E lambda, in m, s and
/// W/m^2; here with the digits that 1/(h c) has.
constexpr double k_photons = 5.0341165675e24;
constexpr double k_rounding = 1e-9;  // of these digits

class PhotoelectronsTest : public testing::Test {
  protected:
    PhotoelectronsTest() {
        scene_.water.bands_nm = {532};
        scene_.camera.intrinsics = {2000, 2000, 320, 240};
        scene_.camera.lens = LensDesc{2.8, 0.0085, 0.95};
        SensorDesc sensor;
        sensor.exposure = 0.01;
        sensor.pixel_pitch = 3.45e-6;
        sensor.quantum_efficiency.values[0] = {0.6};
        scene_.camera.sensor = sensor;
    }
    SensorDesc& sensor() { return *scene_.camera.sensor; }
    Spectrum light(std::initializer_list<double> values) {
        Spectrum result;
        std::ranges::copy(values, result.begin());
        return result;
    }
    void use_table(const std::string& text) {
        sensor().quantum_efficiency = {};
        sensor().quantum_efficiency.where = "scene.yaml:1:1: quantum_efficiency";
        sensor().quantum_efficiency.file = folder_.write("qe.csv", text);
    }

    test::SceneFolder folder_;
    SceneDesc scene_;
};

TEST_F(PhotoelectronsTest, AreCountedAsEmva1288Counts) {
    const double irradiance = 0.02;
    const double photons = k_photons * 3.45e-6 * 3.45e-6 * 0.01 * irradiance * 532e-9;
    EXPECT_NEAR(photons, 6375.5, 0.5);  // what to expect of a well-lit pixel
    EXPECT_NEAR(Photoelectrons(scene_).mean(light({irradiance}), 0) / (0.6 * photons), 1,
                k_rounding);
    sensor().exposure = 0.03;
    EXPECT_NEAR(Photoelectrons(scene_).mean(light({irradiance}), 0) / (1.8 * photons), 1,
                k_rounding);
}

TEST_F(PhotoelectronsTest, WithoutPitchPixelsAreThoseOfTheFocalLength) {
    const double given = Photoelectrons(scene_).mean(light({1}), 0);
    sensor().pixel_pitch.reset();
    const double pitch = 0.0085 / 2000;
    EXPECT_NEAR(Photoelectrons(scene_).mean(light({1}), 0) / given,
                pitch * pitch / (3.45e-6 * 3.45e-6), k_rounding);
    scene_.camera.intrinsics.fy = 1000;
    EXPECT_NEAR(Photoelectrons(scene_).mean(light({1}), 0) / given,
                2 * pitch * pitch / (3.45e-6 * 3.45e-6), k_rounding);
}

TEST_F(PhotoelectronsTest, TheLensGathersByItsFNumberItsFocusAndThePort) {
    const double at_infinity = std::numbers::pi / (4 * 2.8 * 2.8) * 0.95;
    const LensRay ray{0.8, 0.3};  // the port's transmittance is in the radiance already
    EXPECT_NEAR(Photoelectrons(scene_).irradiance_factor(ray, 0), 0.8 * at_infinity, 1e-15);
    const double focus = std::pow((0.5 - 0.0085) / 0.5, 2);
    EXPECT_NEAR(Photoelectrons(scene_).irradiance_factor(ray, 1 / 0.5), 0.8 * focus * at_infinity,
                1e-15);
    FlatPortDesc port;
    scene_.camera.port = port;
    EXPECT_NEAR(Photoelectrons(scene_).irradiance_factor(ray, 1 / 0.5),
                0.8 * focus * at_infinity / (1.334 * 1.334), 1e-15);
    port.radiance_in_air = true;
    scene_.camera.port = port;
    EXPECT_NEAR(Photoelectrons(scene_).irradiance_factor(ray, 1 / 0.5), 0.8 * focus * at_infinity,
                1e-15);
}

/// Light of 1 W/m^2 per band is 3/3 W/m^2 over each mean width of 85 nm (docs/colour.md).
TEST_F(PhotoelectronsTest, OfATableAreTheIntegralOverEachBand) {
    scene_.water.bands_nm = {620, 540, 450};
    use_table("wavelength_nm,qe\n400,0.1\n430,0.5\n520,0.62\n600,0.3\n640,0.28\n");
    const auto efficiency = [](double nm) {
        const double x[] = {400, 430, 520, 600, 640}, y[] = {0.1, 0.5, 0.62, 0.3, 0.28};
        for (int i = 0; i < 4; ++i)
            if (nm >= x[i] && nm <= x[i + 1])
                return y[i] + (y[i + 1] - y[i]) * (nm - x[i]) / (x[i + 1] - x[i]);
        return 0.0;
    };
    // The intervals of 620, 540 and 450 nm, and W/m^2 per nm in each.
    const double begin[] = {580, 495, 405}, end[] = {660, 580, 495}, value[] = {0.3, 0.5, 0.9};
    double expected = 0;
    for (int band = 0; band < 3; ++band) {
        double integral = 0;  // midpoints; the product has bends at whole nanometres only
        constexpr int k_steps = 100'000;
        const double step = (end[band] - begin[band]) / k_steps;
        for (int i = 0; i < k_steps; ++i) {
            const double nm = begin[band] + (i + 0.5) * step;
            integral += efficiency(nm) * nm * 1e-9 * step;
        }
        expected += value[band] / 85 * integral;
    }
    expected *= k_photons * 3.45e-6 * 3.45e-6 * 0.01;
    // The midpoint rule steps by 1e-5 at the table's end, within the interval of 620 nm.
    EXPECT_NEAR(Photoelectrons(scene_).mean(light({0.3, 0.5, 0.9}), 0) / expected, 1, 2e-5);
}

TEST_F(PhotoelectronsTest, NumbersPerBandAreAConstantTableOverEachBand) {
    scene_.water.bands_nm = {620, 540, 450};
    sensor().quantum_efficiency.values[0] = {0.4, 0.4, 0.4};
    const Photoelectrons numbers(scene_);
    use_table("wavelength_nm,qe\n300,0.4\n800,0.4\n");
    const Photoelectrons table(scene_);
    for (const auto& values : {light({1, 0, 0}), light({0, 1, 0}), light({0, 0, 1})})
        EXPECT_NEAR(numbers.mean(values, 0) / table.mean(values, 0), 1, 1e-12);
}

TEST_F(PhotoelectronsTest, ColoursSeeByTheirOwnColumns) {
    sensor().mosaic = SensorMosaic::rggb;
    use_table("wavelength_nm,r,g,b\n400,0.0,0.1,0.5\n600,0.4,0.3,0.1\n");
    const Photoelectrons electrons(scene_);
    const double photons = k_photons * 3.45e-6 * 3.45e-6 * 0.01 * 532e-9;
    const double expected[] = {0.4 * 0.66, 0.1 + 0.2 * 0.66, 0.5 - 0.4 * 0.66};
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(electrons.mean(light({1}), c) / (expected[c] * photons), 1, k_rounding);
}

TEST_F(PhotoelectronsTest, AResponseToPowerIsAnEfficiencyTimesWavelength) {
    use_table("wavelength_nm,qe\n400,20\n500,50\n600,48\n");
    sensor().quantum_efficiency.is_per_power = true;
    sensor().quantum_efficiency.peak = 0.7;  // at 500 nm: 50/500 is the greatest
    scene_.water.bands_nm = {600};
    const double photons = k_photons * 3.45e-6 * 3.45e-6 * 0.01 * 600e-9;
    EXPECT_NEAR(Photoelectrons(scene_).mean(light({1}), 0) / (0.7 * 0.8 * photons), 1, k_rounding);
}

TEST_F(PhotoelectronsTest, TablesThatCannotBeMeantAreRefused) {
    const auto refuses = [&](const std::string& text, const std::string& part) {
        use_table(text);
        try {
            Photoelectrons{scene_};
            ADD_FAILURE() << text;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        }
    };
    refuses("wavelength_nm,qe\n400,0.5\n600,1.2\n", "add the greatest efficiency");
    refuses("wavelength_nm,qe\n400,0.5\n600,-0.1\n", "negative value at 600 nm");
    refuses("wavelength_nm,qe\n600,0.5\n700,0.1\n", "no light of water.bands");
    refuses("wavelength_nm,r,g,b\n400,0,1,0\n600,0,0,0\n", "qe");
}

}  // namespace
}  // namespace uw
