// ctest labels: statistical analytic
#include "core/image/camera_sensor.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace uw {
namespace {

constexpr double k_sigmas = 5;  // see random_counts.cpp
constexpr int k_width = 512, k_height = 320;
constexpr double k_pixels = k_width * k_height;

/// Like a machine-vision sensor of 3.45 um.
SensorDesc usual_sensor() {
    SensorDesc desc;
    desc.exposure = 0.02;
    desc.full_well = 10500;
    desc.dark_current = 100;
    desc.read_noise = 2.4;
    desc.gain = 0.38;
    desc.black_level = 60;
    desc.bit_depth = 12;
    return desc;
}

std::vector<double> image_of(const SensorDesc& desc, double electrons,
                             const ImageIdentity& identity = {}) {
    const SensorReadout readout(desc, identity);
    std::vector<double> numbers;
    for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < k_width; ++x) numbers.push_back(readout.number(electrons, x, y));
    return numbers;
}

double mean_of(const std::vector<double>& numbers) {
    double sum = 0;
    for (const double number : numbers) sum += number;
    return sum / static_cast<double>(numbers.size());
}
double covariance(const std::vector<double>& a, const std::vector<double>& b) {
    const double mean_a = mean_of(a), mean_b = mean_of(b);
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - mean_a) * (b[i] - mean_b);
    return sum / static_cast<double>(a.size() - 1);
}
double variance(const std::vector<double>& numbers) {
    return covariance(numbers, numbers);
}

/// EMVA 1288: sigma_y^2 = K^2 (sigma_read^2 + I t + mu_e) + 1/12, mu_y = K (mu_e + I t) + black: a
/// line of slope K over the mean.
TEST(SensorReadout, ThePhotonTransferCurveHasTheSlopeOfTheGain) {
    const SensorDesc desc = usual_sensor();
    const double K = *desc.gain, dark = desc.dark_current * *desc.exposure;
    double weights = 0, means = 0, variances = 0, squares = 0, products = 0;
    for (const double electrons : {0.0, 3.0, 20.0, 100.0, 500.0, 2000.0, 5000.0, 8000.0}) {
        const std::vector<double> numbers = image_of(desc, electrons);
        const double in_electrons = electrons + dark + 2.4 * 2.4;
        const double expected = K * K * in_electrons + 1.0 / 12;
        // The standard error of a variance; the excess kurtosis of the Poisson part is 1/mean.
        const double excess = (electrons + dark) / (in_electrons * in_electrons);
        const double error = expected * std::sqrt((2 + excess) / k_pixels);
        const double mean = mean_of(numbers), found = variance(numbers);
        EXPECT_NEAR(found, expected, k_sigmas * error) << electrons;
        EXPECT_NEAR(mean, K * (electrons + dark) + 60, k_sigmas * std::sqrt(expected / k_pixels))
            << electrons;
        const double weight = 1 / (error * error);
        weights += weight;
        means += weight * mean;
        variances += weight * found;
        squares += weight * mean * mean;
        products += weight * mean * found;
    }
    const double spread = squares - means * means / weights;
    const double slope = (products - means * variances / weights) / spread;
    EXPECT_NEAR(slope, K, k_sigmas / std::sqrt(spread));
    EXPECT_LT(k_sigmas / std::sqrt(spread), 0.01 * K);  // the bound says something
    const double intercept = (variances - slope * means) / weights + slope * 60;
    EXPECT_NEAR(intercept, K * K * 2.4 * 2.4 + 1.0 / 12, 0.1);
}

TEST(SensorReadout, WithoutNoiseIsTheRoundedNumber) {
    SensorDesc desc = usual_sensor();
    desc.shot_noise = false;
    desc.dark_current = desc.read_noise = 0;
    const SensorReadout readout(desc, {});
    for (const double electrons : {0.0, 0.9, 1.0, 1000.0, 9999.3})
        EXPECT_EQ(readout.number(electrons, 3, 4), std::round(0.38 * electrons + 60)) << electrons;
}

TEST(SensorReadout, WellsAndConverterSaturate) {
    SensorDesc desc = usual_sensor();
    desc.read_noise = 0;
    const double full = std::round(0.38 * 10500 + 60);
    for (const double number : image_of(desc, 20000)) ASSERT_EQ(number, full);
    desc.gain = 1;  // white, 4095, comes before the wells are full
    for (const double number : image_of(desc, 9000)) ASSERT_EQ(number, 4095);
    desc.gain.reset();  // full wells are white
    EXPECT_EQ(SensorReadout(desc, {}).number(1e9, 0, 0), 4095);
    desc.black_level = 0;
    desc.read_noise = 50;
    double least = 4095;
    for (const double number : image_of(desc, 0)) least = std::min(least, number);
    EXPECT_EQ(least, 0);
}

TEST(SensorReadout, DarkImagesHaveTheBlackLevelAndTheDarkCurrent) {
    SensorDesc desc = usual_sensor();
    desc.dark_current = 0;
    EXPECT_NEAR(mean_of(image_of(desc, 0)), 60,
                k_sigmas * std::sqrt((0.38 * 0.38 * 2.4 * 2.4 + 1.0 / 12) / k_pixels));
    desc.dark_current = 5000;  // 100 electrons, with a shot noise of 10
    const double expected = 0.38 * 0.38 * (100 + 2.4 * 2.4) + 1.0 / 12;
    EXPECT_NEAR(mean_of(image_of(desc, 0)), 98, k_sigmas * std::sqrt(expected / k_pixels));
    EXPECT_NEAR(variance(image_of(desc, 0)), expected,
                k_sigmas * expected * std::sqrt(2 / k_pixels));
}

/// What belongs to the pixels stays from image to image, the rest does not: the covariance of two
/// images is K^2 (PRNU^2 mu^2 + DSNU^2).
TEST(SensorReadout, FixedPatternsStayAndTemporalNoiseDoesNot) {
    SensorDesc desc = usual_sensor();
    desc.prnu = 0.02;
    desc.dsnu = 12;
    const double electrons = 2000, dark = 2;
    const auto first = image_of(desc, electrons, {"", 1}),
               second = image_of(desc, electrons, {"", 2});
    const double fixed = 0.38 * 0.38 * (std::pow(0.02 * electrons, 2) + 12.0 * 12.0);
    const double all = fixed + 0.38 * 0.38 * (electrons + dark + 2.4 * 2.4) + 1.0 / 12;
    // Normal variables have var(cov) = (s1^2 s2^2 + cov^2) / n.
    EXPECT_NEAR(covariance(first, second), fixed,
                k_sigmas * std::sqrt((all * all + fixed * fixed) / k_pixels));
    EXPECT_NEAR(variance(first), all, k_sigmas * all * std::sqrt(2 / k_pixels));
    const auto other = image_of(desc, electrons, {"right", 1});
    EXPECT_NEAR(covariance(first, other), 0, k_sigmas * all / std::sqrt(k_pixels));
}

TEST(SensorReadout, NoiseDiffersByFrameCameraSeedPixelAndColour) {
    SensorDesc desc = usual_sensor(), reseeded = desc;
    reseeded.seed = 1;
    const double electrons = 1000, all = 0.38 * 0.38 * (1002 + 2.4 * 2.4) + 1.0 / 12;
    const auto first = image_of(desc, electrons, {"left", 1});
    const double none = k_sigmas * all / std::sqrt(k_pixels);
    EXPECT_NEAR(covariance(first, image_of(desc, electrons, {"left", 2})), 0, none);
    EXPECT_NEAR(covariance(first, image_of(desc, electrons, {"right", 1})), 0, none);
    EXPECT_NEAR(covariance(first, image_of(reseeded, electrons, {"left", 1})), 0, none);
    auto moved = first;
    std::rotate(moved.begin(), moved.begin() + 1, moved.end());
    EXPECT_NEAR(covariance(first, moved), 0, none);
    std::rotate(moved.begin(), moved.begin() + k_width, moved.end());
    EXPECT_NEAR(covariance(first, moved), 0, none);
    const SensorReadout readout(desc, {"left", 1});
    std::vector<double> green;
    for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < k_width; ++x) green.push_back(readout.number(electrons, x, y, 1));
    EXPECT_NEAR(covariance(first, green), 0, none);
    EXPECT_EQ(first, image_of(desc, electrons, {"left", 1}));
}

TEST(SensorReadout, MosaicsAreNamedByTheirFirstTwoRows) {
    for (const auto& [name, mosaic] : k_sensor_mosaics) {
        if (!is_bayer(mosaic)) continue;
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                const char letter = name[static_cast<std::size_t>(2 * (y % 2) + x % 2)];
                EXPECT_EQ("rgb"[colour_at(mosaic, x, y)], letter) << name << x << y;
            }
    }
    EXPECT_EQ(colour_at(SensorMosaic::mono, 1, 1), 0U);
}

}  // namespace
}  // namespace uw
