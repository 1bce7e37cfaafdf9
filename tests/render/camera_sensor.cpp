// ctest labels: analytic metamorphic statistical
// What a camera's sensor makes of an image (docs/camera-image.md).
#include "core/image/camera_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/image_laws.h"
#include "tests/support/test_scene.h"

namespace uw::test {
namespace {

class CameraSensors : public testing::Test {
  protected:
    CameraSensors() {
        desc_ = pinhole_scene(40, 30);
        desc_.geometry = {plane_at_z(2)};
        desc_.lamps = {isotropic_lamp({0.3, -0.2, 0}, 40)};
        desc_.camera.lens = LensDesc{2.8, 0.0085, 0.95};
        SensorDesc sensor;
        sensor.exposure = 0.01;
        sensor.pixel_pitch = 3.45e-6;
        sensor.mosaic = SensorMosaic::three;
        sensor.quantum_efficiency.values = {PerBand{0.5, 0.1, 0}, PerBand{0.1, 0.6, 0.1},
                                            PerBand{0, 0.1, 0.4}};
        sensor.gain = 0.5;
        sensor.bit_depth = 16;
        desc_.camera.sensor = sensor;
    }
    Film film(const RenderOptions& options = {.layers = "sensor"}) {
        Renderer renderer;
        renderer.set_scene(SceneDesc(desc_));
        return renderer.render(options);
    }
    /// The sensor's numbers of a pixel.
    std::vector<double> numbers(const Film& film, int x, int y) {
        const auto pixel = film.pixel(x, y);
        return {pixel.begin() + 4, pixel.end()};
    }
    SensorDesc& sensor() { return *desc_.camera.sensor; }

    SceneDesc desc_;
};

/// From radiance to numbers by hand: cos^4, pi/(4 N^2), h c / lambda, bands as wide as they are.
TEST_F(CameraSensors, CountWhatTheRadianceOfEachBandMakes) {
    sensor().shot_noise = false;
    const Film image = film();
    const auto& bands = desc_.water.bands_nm;
    ASSERT_EQ(bands, (std::vector<double>{620, 540, 450}));
    // The bands' intervals are 580 to 660, 495 to 580 and 405 to 495 nm: their fractions of the
    // power and their middles.
    const double width_ratio[] = {80.0 / 85, 1, 90.0 / 85}, middle[] = {620, 537.5, 450};
    const IntrinsicsDesc& k = desc_.camera.intrinsics;
    double most = 0;
    for (int y = 0; y < 30; y += 7)
        for (int x = 0; x < 40; x += 7) {
            const double u = (x + 0.5 - k.cx) / k.fx, v = (y + 0.5 - k.cy) / k.fy;
            const double lens =
                std::numbers::pi / (4 * 2.8 * 2.8) * 0.95 / std::pow(1 + u * u + v * v, 2);
            for (std::size_t c = 0; c < 3; ++c) {
                double electrons = 0;
                for (std::size_t b = 0; b < 3; ++b)
                    electrons += sensor().quantum_efficiency.values[c][b] * 5.0341165675e24 *
                                 3.45e-6 * 3.45e-6 * 0.01 * width_ratio[b] * middle[b] * 1e-9 *
                                 lens * static_cast<double>(image.pixel(x, y)[b]);
                // Half a number of rounding.
                EXPECT_NEAR(numbers(image, x, y)[c], 0.5 * electrons, 0.5 + 1e-9 * electrons);
                most = std::max(most, electrons);
            }
        }
    EXPECT_GT(most, 1000);  // so that half a number is little
}

TEST_F(CameraSensors, NoiseDependsNeitherOnThreadsNorOnCrops) {
    const Film whole =
        expect_same_for_threads_and_windows(desc_, {.layers = "sensor"}, {11, 5, 30, 22});
    const Film later = film({.layers = "sensor", .frame = 1});
    int differ = 0;
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) differ += numbers(later, x, y) != numbers(whole, x, y) ? 1 : 0;
    EXPECT_GT(differ, 1100);  // of 1200
}

/// A mosaic is, pixel by pixel, one of the three numbers that a sensor with all colours counts.
TEST_F(CameraSensors, AMosaicSeesOneColourPerPixel) {
    sensor().shot_noise = false;
    const Film three = film();
    sensor().mosaic = SensorMosaic::gbrg;
    const Film mosaic = film();
    ASSERT_EQ(mosaic.channel_names().size(), 5U);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x)
            EXPECT_EQ(numbers(mosaic, x, y)[0],
                      numbers(three, x, y)[colour_at(SensorMosaic::gbrg, x, y)]);
}

/// More bands than three bring their totals with them, and colours are those of the bands.
TEST_F(CameraSensors, AnyNumberOfBandsIsCounted) {
    sensor().shot_noise = false;
    sensor().mosaic = SensorMosaic::mono;
    sensor().quantum_efficiency.values = {PerBand{0.5, 0.5, 0.5}, {}, {}};
    const Film three = film();
    desc_.water = WaterDesc{};
    desc_.water.bands_nm = {540};
    desc_.lamps[0].intensity = {40};
    sensor().quantum_efficiency.values[0] = {0.5};
    const Film one = film();
    ASSERT_EQ(one.channel_names(),
              (std::vector<std::string>{"R", "G", "B", "A", "total.540nm", "sensor.V"}));
    const double radiance = static_cast<double>(one.pixel(20, 15)[4]);
    const IntrinsicsDesc& k = desc_.camera.intrinsics;
    const double u = (20.5 - k.cx) / k.fx, v = (15.5 - k.cy) / k.fy;
    const double electrons = 0.5 * 5.0341165675e24 * 3.45e-6 * 3.45e-6 * 0.01 * 540e-9 * radiance *
                             std::numbers::pi / (4 * 2.8 * 2.8) * 0.95 /
                             std::pow(1 + u * u + v * v, 2);
    EXPECT_NEAR(static_cast<double>(one.pixel(20, 15)[5]), 0.5 * electrons, 0.5 + 1e-6 * electrons);
    EXPECT_GT(static_cast<double>(three.pixel(20, 15)[4]), 0);
}

/// Pixels that no light can reach are dark, not absent.
TEST_F(CameraSensors, PixelsWithoutRayHaveDarkNoise) {
    sensor().black_level = 100;
    sensor().read_noise = 10;
    FlatPortDesc port;
    port.normal = glm::normalize(Vector3(0.9, 0, 0.4));  // seen at more than 90 degrees on the left
    desc_.camera.port = port;
    const Film image = film();
    ASSERT_EQ(image.pixel(0, 15)[k_alpha], 0);
    ASSERT_EQ(image.pixel(39, 15)[k_alpha], 1);
    double sum = 0;
    for (int y = 0; y < 30; ++y) sum += numbers(image, 0, y)[0];
    EXPECT_NEAR(sum / 30, 100, 5 * 5 / std::sqrt(30.0));  // five standard errors
}

}  // namespace
}  // namespace uw::test
