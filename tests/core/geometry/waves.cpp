// ctest labels: analytic threads
// Waves on the water: dispersion, spectra, trochoids, tiles of random seas, and where rays cross
// them.
#include "core/geometry/waves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/image/film.h"
#include "core/image/image_file.h"
#include "tests/support/adaptive_quadrature.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

constexpr double k_wave_pi = std::numbers::pi;

WavesDesc sum_of(std::vector<SineWaveDesc> waves) {
    WavesDesc desc;
    desc.shape = std::move(waves);
    return desc;
}

/// Some waves in all directions.
WavesDesc choppy(double steepness) {
    return sum_of({{0.20, 5.0, 20, 30, steepness},
                   {0.07, 1.7, -60, 100, steepness},
                   {0.02, 0.6, 140, -50, steepness}});
}

WaveSpectrumDesc sea_of(WaveSpectrumDesc::Model model) {
    WaveSpectrumDesc sea;
    sea.model = model;
    sea.wind = 7;
    sea.direction = 30;
    sea.fetch = 3000;
    sea.tile = 40;
    sea.resolution = 128;
    sea.seed = 5;
    return sea;
}

WavesDesc desc_of(const WaveSpectrumDesc& sea, std::optional<double> depth = std::nullopt) {
    WavesDesc desc;
    desc.shape = sea;
    desc.depth = depth;
    return desc;
}

TEST(Waves, HaveTheFrequenciesOfTheirLimits) {
    // Deep gravity waves, omega^2 = g k; surface tension adds 7e-6 k^2 of it.
    EXPECT_NEAR(wave_frequency(0.1, {}), std::sqrt(9.80665 * 0.1), 1e-6);
    // Shallow water: the speed is sqrt(g d), less the fraction (kd)^2 / 6.
    EXPECT_NEAR(wave_frequency(0.01, 1.0) / 0.01, std::sqrt(9.80665), 1e-4);
    // The slowest ripples: 0.23 m/s at 17 mm, where gravity and tension are equal.
    const double k = std::sqrt(9.80665 / 7.29e-5);
    EXPECT_NEAR(2 * k_wave_pi / k, 0.0171, 1e-4);
    EXPECT_NEAR(wave_frequency(k, {}) / k, std::pow(4 * 9.80665 * 7.29e-5, 0.25), 1e-9);
    for (const double number : {0.05, 1.0, 30.0, 800.0})
        for (const std::optional<double> depth : {std::optional<double>(), std::optional(0.3)}) {
            const double step = 1e-4 * number;
            const double difference =
                (wave_frequency(number + step, depth) - wave_frequency(number - step, depth)) /
                (2 * step);
            EXPECT_NEAR(wave_group_velocity(number, depth), difference, 1e-6 * difference);
        }
}

TEST(Waves, TravelAtTheirPhaseSpeed) {
    WavesDesc desc = sum_of({{0.3, 8, 0, 40, 0}});
    for (const std::optional<double> depth : {std::optional<double>(), std::optional(0.7)}) {
        desc.depth = depth;
        const WaterWaves before(desc, 2), after(desc, 2.5);
        const double k = 2 * k_wave_pi / 8;
        const double speed =
            std::sqrt((9.80665 / k + 7.29e-5 * k) * (depth ? std::tanh(k * *depth) : 1));
        for (const double u : {0.0, 1.3, 5.5})
            EXPECT_NEAR(after.at(u + 0.5 * speed, 3).height, before.at(u, -8).height, 1e-12);
    }
    EXPECT_NEAR(WaterWaves(sum_of({{0.3, 8, 90, 0, 0}}), 0).at(5, 0).height, 0.3, 1e-12);
    EXPECT_NEAR(WaterWaves(sum_of({{0.3, 8, 90, 0, 0}}), 0).at(5, 2).height, 0, 1e-12);
}

TEST(Waves, AreGerstnersTrochoids) {
    // One as steep as may be: the water at a has moved to a - A sin ka, and has the height A cos
    // ka.
    const double length = 3, k = 2 * k_wave_pi / length, amplitude = 0.94 / k;
    const WaterWaves steep(sum_of({{amplitude, length, 0, 0, 1}}), 0);
    for (double a = -4; a < 4; a += 0.037) {
        const WavePoint point = steep.at(a - amplitude * std::sin(k * a), 1.7);
        EXPECT_NEAR(point.height, amplitude * std::cos(k * a), 1e-11);
        // tan of the slope: dz/da over dx/da.
        EXPECT_NEAR(point.slope_u,
                    -amplitude * k * std::sin(k * a) / (1 - amplitude * k * std::cos(k * a)), 1e-9);
        EXPECT_NEAR(point.slope_v, 0, 1e-12);
    }
    // Several: the sum of their motions.
    const WavesDesc desc = choppy(0.9);
    const WaterWaves waves(desc, 0);
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> uniform(-5, 5);
    for (int n = 0; n < 300; ++n) {
        const double a = uniform(rng), b = uniform(rng);
        double u = a, v = b, height = 0;
        for (const SineWaveDesc& wave : std::get<std::vector<SineWaveDesc>>(desc.shape)) {
            const double turn = wave.direction * k_degree;
            const double angle =
                2 * k_wave_pi / wave.wavelength * (std::cos(turn) * a + std::sin(turn) * b) +
                wave.phase * k_degree;
            u -= 0.9 * wave.amplitude * std::cos(turn) * std::sin(angle);
            v -= 0.9 * wave.amplitude * std::sin(turn) * std::sin(angle);
            height += wave.amplitude * std::cos(angle);
        }
        EXPECT_NEAR(waves.at(u, v).height, height, 1e-11);
    }
}

TEST(Waves, SlopesAreTheDerivativesOfHeights) {
    std::vector<WaterWaves> all;
    all.emplace_back(choppy(0), 0.3);
    all.emplace_back(choppy(0.8), 0.3);
    all.emplace_back(desc_of(sea_of(WaveSpectrumDesc::Model::jonswap)), 1.7);
    std::mt19937 rng(2);
    std::uniform_real_distribution<double> uniform(-60, 60);
    constexpr double k_step = 1e-5;
    for (const WaterWaves& waves : all)
        for (int n = 0; n < 300; ++n) {
            const double u = uniform(rng), v = uniform(rng);
            const WavePoint point = waves.at(u, v);
            // Rounding of heights of 1 m over the step: 1e-11 / 1e-5.
            EXPECT_NEAR(
                point.slope_u,
                (waves.at(u + k_step, v).height - waves.at(u - k_step, v).height) / (2 * k_step),
                1e-6);
            EXPECT_NEAR(
                point.slope_v,
                (waves.at(u, v + k_step).height - waves.at(u, v - k_step).height) / (2 * k_step),
                1e-6);
            EXPECT_GE(point.height, waves.lowest());
            EXPECT_LE(point.height, waves.highest());
            EXPECT_LE(std::hypot(point.slope_u, point.slope_v), waves.steepest());
            const Vector3 normal = point.normal();
            EXPECT_NEAR(glm::dot(normal, Vector3(1, 0, point.slope_u)), 0, 1e-12);
            EXPECT_NEAR(glm::dot(normal, Vector3(0, 1, point.slope_v)), 0, 1e-12);
        }
    // Across the edges of a sea's cells, too.
    const double edge = 40.0 / 128 * 17;
    const WavePoint left = all[2].at(edge - 1e-9, 3.3), right = all[2].at(edge + 1e-9, 3.3);
    EXPECT_NEAR(left.slope_u, right.slope_u, 1e-7);
    EXPECT_NEAR(left.slope_v, right.slope_v, 1e-7);
}

TEST(Waves, SpectraHaveTheirClosedForms) {
    WaveSpectrumDesc sea = sea_of(WaveSpectrumDesc::Model::pierson_moskowitz);
    sea.wind_height = 19.5;
    const auto variance = [&] {
        return AdaptiveQuadrature::integrate(
            [&](double omega) { return wave_spectrum(sea, omega); }, 0.1, 60, 1e-9);
    };
    // int alpha g^2 w^-5 e^(-b / w^4) dw = alpha g^2 / (4 b), b = 0.74 (g / U)^4; above 60 rad/s is
    // alpha g^2 / (4 60^4) = 1.5e-8 of it.
    EXPECT_NEAR(variance(), 0.0081 * std::pow(7, 4) / (4 * 0.74 * std::pow(9.80665, 2)), 1e-7);
    // The wind 19.5 m up is 6 % stronger than at 10 m; the waves grow with its square.
    const double at_mast = std::sqrt(variance());
    sea.wind_height = 10;
    EXPECT_NEAR(std::sqrt(variance()) / at_mast,
                std::pow(1 + std::sqrt(0.0013) / 0.4 * std::log(1.95), 2), 1e-6);

    sea = sea_of(WaveSpectrumDesc::Model::jonswap);
    const double alpha = 0.076 * std::pow(49 / (3000 * 9.80665), 0.22);
    const double peak = 22 * std::cbrt(9.80665 * 9.80665 / (7 * 3000));
    sea.gamma = 1;  // without an enhanced peak
    EXPECT_NEAR(variance(), alpha * std::pow(9.80665, 2) / (5 * std::pow(peak, 4)), 1e-7);
    const double without = wave_spectrum(sea, peak);
    sea.gamma = 3.3;
    EXPECT_NEAR(wave_spectrum(sea, peak), 3.3 * without, 1e-12);
    EXPECT_NEAR(wave_spectrum(sea, 1.09 * peak) * std::pow(3.3, -std::exp(-0.5)),
                alpha * std::pow(9.80665, 2) * std::pow(1.09 * peak, -5) *
                    std::exp(-1.25 * std::pow(1.09, -4)),
                1e-12);
    for (const double s : {0.5, 3.0, 40.0, 1000.0})
        EXPECT_NEAR(
            AdaptiveQuadrature::integrate([&](double angle) { return wave_spreading(angle, s); },
                                          -k_wave_pi, 0, 1e-9),
            0.5, 1e-7);
    EXPECT_NEAR(wave_spreading(0, 1), 1 / k_wave_pi, 1e-12);
}

TEST(Waves, ShallowSeasAreThoseOfTma) {
    // Kitaigorodskii: the saturated tail is one of wave numbers, k^-3 dk/domega at a frequency.
    for (const double depth : {0.3, 2.0, 15.0})
        for (const double k : {0.05, 0.4, 2.0}) {
            const double omega = wave_frequency(k, depth);
            const double deep = omega * omega / 9.80665;  // its wave number in deep water
            const double factor = std::pow(k, -3) / wave_group_velocity(k, depth) /
                                  (std::pow(deep, -3) / wave_group_velocity(deep, {}));
            // Surface tension, which it leaves out, is 3e-5 of gravity at 2 rad/m.
            EXPECT_NEAR(shoaling_factor(k, depth), factor, 2e-4) << depth << " " << k;
        }
    EXPECT_NEAR(shoaling_factor(1000, 10), 1, 1e-12);
}

/// The variance of a sea of these wave vectors: int S(omega) D(angle) domega dangle over |k_u|,
/// |k_v|
/// <= largest, beyond the square |k_u|, |k_v| <= least.
SlopeVariance variance_of(const WaveSpectrumDesc& sea, double least, double largest, int power) {
    SlopeVariance sum;
    for (const bool along : {true, false}) {
        double& part = along ? sum.along : sum.across;
        part = AdaptiveQuadrature::integrate(
            [&](double angle) {
                const double reach =
                    1 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
                const double weight =
                    along ? std::pow(std::cos(angle), 2) : std::pow(std::sin(angle), 2);
                return weight * wave_spreading(angle - sea.direction * k_degree, sea.spreading) *
                       AdaptiveQuadrature::integrate(
                           [&](double k) {
                               return std::pow(k, power) *
                                      wave_spectrum(sea, wave_frequency(k, {})) *
                                      wave_group_velocity(k, {});
                           },
                           least * reach, largest * reach, 1e-8);
            },
            -k_wave_pi, k_wave_pi, 1e-7);
    }
    return sum;
}

TEST(Waves, SeasHaveTheirSpectrumsHeightAndSlopes) {
    for (const auto model :
         {WaveSpectrumDesc::Model::pierson_moskowitz, WaveSpectrumDesc::Model::jonswap}) {
        WaveSpectrumDesc sea = sea_of(model);
        sea.tile = 500;
        sea.resolution = 256;
        const double step = 2 * k_wave_pi / sea.tile, largest = 127.5 * step;
        const WaveStatistics found = WaterWaves(desc_of(sea), 0).statistics();
        const double variance = variance_of(sea, 0.5 * step, largest, 0).total();
        const SlopeVariance slopes = variance_of(sea, 0.5 * step, largest, 2);
        // Each wave vector's square by 2 x 2 nodes: waves at the peak are some ten squares from 0.
        EXPECT_NEAR(found.height_variance, variance, 2e-3 * variance);
        EXPECT_NEAR(found.slopes.along, slopes.along, 2e-3 * slopes.along);
        EXPECT_NEAR(found.slopes.across, slopes.across, 2e-3 * slopes.across);
        EXPECT_NEAR(found.significant_height(), 4 * std::sqrt(variance),
                    2e-3 * found.significant_height());
    }
    // The whole spectrum, Pierson and Moskowitz's: H_s = 0.21 U^2 / g, less waves of less than 4 m,
    // alpha g^2 / (4 omega^4) at omega^2 = 2 pi g / 4 m: 0.2 % of the variance and more in corners.
    WaveSpectrumDesc sea = sea_of(WaveSpectrumDesc::Model::pierson_moskowitz);
    sea.wind_height = 19.5;
    sea.tile = 500;
    sea.resolution = 256;
    EXPECT_NEAR(WaterWaves(desc_of(sea), 0).statistics().significant_height(),
                4 * std::sqrt(0.0081 / (4 * 0.74)) * 49 / 9.80665, 0.01);
}

/// The wave i, j of a sea's heights: 2 / N^2 sum h e^{-i k.x}.
std::complex<double> wave_of(const WaterWaves& waves, double tile, int count, int i, int j) {
    std::complex<double> sum;
    for (int y = 0; y < count; ++y)
        for (int x = 0; x < count; ++x)
            sum += waves.at(tile * x / count, tile * y / count).height *
                   std::polar(2.0 / (count * count), -2 * k_wave_pi * (i * x + j * y) / count);
    return sum;
}

TEST(Waves, SeasObeyParseval) {
    WaveSpectrumDesc sea = sea_of(WaveSpectrumDesc::Model::jonswap);
    // No waves against the wind: two of opposite vectors would stand, and their energy come and go.
    sea.spreading = 200;
    const WaterWaves waves(desc_of(sea), 3);
    WaveStatistics mean;
    double height = 0;
    for (int y = 0; y < sea.resolution; ++y)
        for (int x = 0; x < sea.resolution; ++x) {
            const WavePoint point =
                waves.at(sea.tile * x / sea.resolution, sea.tile * y / sea.resolution);
            const double weight = 1.0 / (sea.resolution * sea.resolution);
            height += weight * point.height;
            mean.height_variance += weight * point.height * point.height;
            mean.slopes.along += weight * point.slope_u * point.slope_u;
            mean.slopes.across += weight * point.slope_v * point.slope_v;
        }
    const WaveStatistics expected = waves.statistics();
    EXPECT_NEAR(height, 0, 1e-12);
    EXPECT_NEAR(mean.height_variance, expected.height_variance, 1e-9 * expected.height_variance);
    EXPECT_NEAR(mean.slopes.along, expected.slopes.along, 1e-9 * expected.slopes.along);
    EXPECT_NEAR(mean.slopes.across, expected.slopes.across, 1e-9 * expected.slopes.across);
}

TEST(Waves, SeasTravelWithTheWindByDispersion) {
    WaveSpectrumDesc sea = sea_of(WaveSpectrumDesc::Model::jonswap);
    sea.spreading = 200;
    sea.resolution = 64;
    constexpr double k_time = 0.4;
    for (const std::optional<double> depth : {std::optional<double>(), std::optional(1.0)}) {
        const WaterWaves before(desc_of(sea, depth), 0), after(desc_of(sea, depth), k_time);
        for (const auto& [i, j] : {std::pair{5, 3}, {8, 4}, {6, 2}}) {
            const std::complex<double> a = wave_of(before, sea.tile, 64, i, j);
            const std::complex<double> b = wave_of(after, sea.tile, 64, i, j);
            const double k = 2 * k_wave_pi / sea.tile * std::hypot(i, j);
            const double omega = std::sqrt((9.80665 * k + 7.29e-5 * k * k * k) *
                                           (depth ? std::tanh(k * *depth) : 1));
            EXPECT_GT(std::abs(a), 1e-4);
            EXPECT_NEAR(std::abs(b), std::abs(a), 1e-9);
            EXPECT_NEAR(std::abs(b - a * std::polar(1.0, -omega * k_time)), 0, 1e-9);
            EXPECT_NEAR(std::abs(wave_of(before, sea.tile, 64, -i, j + 7)), 0, 1e-9);
        }
    }
}

TEST(Waves, AFinerSeaHasTheSameLargeWaves) {
    WaveSpectrumDesc sea = sea_of(WaveSpectrumDesc::Model::jonswap);
    sea.resolution = 32;
    const WaterWaves coarse(desc_of(sea), 1);
    sea.resolution = 96;
    const WaterWaves fine(desc_of(sea), 1);
    for (const auto& [i, j] : {std::pair{1, 0}, {-3, 5}, {4, 11}, {0, 7}})
        EXPECT_NEAR(
            std::abs(wave_of(coarse, sea.tile, 32, i, j) - wave_of(fine, sea.tile, 96, i, j)), 0,
            1e-12);
    sea.seed = 6;
    EXPECT_GT(std::abs(WaterWaves(desc_of(sea), 1).at(3, 4).height - fine.at(3, 4).height), 1e-3);
}

TEST(Waves, SeasRepeatAndDoNotDependOnThreads) {
    const WaveSpectrumDesc sea = sea_of(WaveSpectrumDesc::Model::jonswap);
    const WaterWaves waves(desc_of(sea, 3), 12.5);
    std::vector<WavePoint> one, many;
    const auto sample = [&](std::vector<WavePoint>& points) {
        const WaterWaves made(desc_of(sea, 3), 12.5);
        for (int n = 0; n < 500; ++n) points.push_back(made.at(0.37 * n, -0.11 * n));
    };
    with_threads(1, [&] { sample(one); });
    sample(many);
    for (std::size_t n = 0; n < one.size(); ++n) {
        EXPECT_EQ(one[n].height, many[n].height);
        EXPECT_EQ(one[n].slope_u, many[n].slope_u);
        EXPECT_EQ(one[n].slope_v, many[n].slope_v);
        const double u = 0.37 * static_cast<double>(n), v = -0.11 * static_cast<double>(n);
        // 500 m from the origin places are rounded by 1e-13 m.
        EXPECT_NEAR(waves.at(u + 3 * sea.tile, v - 11 * sea.tile).height, one[n].height, 1e-11);
    }
}

/// The first crossing by small steps, and then by halving.
std::optional<double> searched(const WaterWaves& waves, const Point3& origin,
                               const Vector3& direction, double farthest, double step) {
    const auto above = [&](double s) {
        const Point3 p = origin + s * direction;
        return p.z > waves.at(p.x, p.y).height;
    };
    const bool begins_above = above(0);
    for (double s = step; s < farthest; s += step) {
        if (above(s) == begins_above) continue;
        double low = s - step, high = s;
        for (int n = 0; n < 60; ++n) {
            const double middle = 0.5 * (low + high);
            (above(middle) == begins_above ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }
    return std::nullopt;
}

TEST(Waves, RaysCrossThemWhereADenseSearchSays) {
    WaveSpectrumDesc sea = sea_of(WaveSpectrumDesc::Model::jonswap);
    sea.tile = 12;
    sea.resolution = 64;
    std::vector<WaterWaves> all;
    all.emplace_back(choppy(0), 0.3);
    all.emplace_back(choppy(1), 0.3);
    all.emplace_back(desc_of(sea), 0.0);
    std::mt19937 rng(4);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int hits = 0, misses = 0;
    for (const WaterWaves& waves : all)
        for (int n = 0; n < 150; ++n) {
            // From below and from above, steep and grazing, and some from between the crests.
            const bool from_below = n % 3 != 0;
            const Point3 origin{10 * uniform(rng), 10 * uniform(rng),
                                n % 5 == 0 ? 0.1 * uniform(rng) : (from_below ? -1.0 : 1.0)};
            const double rise = std::pow(std::abs(uniform(rng)), 2) * (from_below ? 1 : -1);
            const double turn = 4 * uniform(rng);
            const Vector3 direction = glm::normalize(Vector3(std::cos(turn), std::sin(turn), rise));
            constexpr double k_farthest = 15, k_search_step = 1e-3;
            const std::optional<double> found = waves.intersect(origin, direction, k_farthest);
            const std::optional<double> expected =
                searched(waves, origin, direction, k_farthest, k_search_step);
            if (!expected) {
                ++misses;
                // The search may step over a crest that the ray touches.
                if (!found) continue;
            } else {
                ++hits;
                ASSERT_TRUE(found) << n;
                if (*found > *expected - 1e-6) {
                    EXPECT_NEAR(*found, *expected, 1e-6) << n;
                    continue;
                }
            }
            // Earlier than the search found: there it must cross indeed.
            const auto gap = [&](double s) {
                const Point3 p = origin + s * direction;
                return p.z - waves.at(p.x, p.y).height;
            };
            EXPECT_LE(gap(*found - 1e-6) * gap(*found + 1e-6), 0) << n;
        }
    EXPECT_GT(hits, 300);
    EXPECT_GT(misses, 20);
}

TEST(Waves, RaysThatMissThemDoNotCross) {
    const WaterWaves waves(choppy(0.5), 0);
    EXPECT_FALSE(waves.intersect({0, 0, -1}, {0, 0, -1}));
    EXPECT_FALSE(waves.intersect({0, 0, -1}, {1, 0, 0}));
    EXPECT_FALSE(waves.intersect({0, 0, -1}, {0, 0, 1}, 0.5));
    const std::optional<double> up = waves.intersect({0.3, 0.2, -5}, {0, 0, 1});
    ASSERT_TRUE(up);
    EXPECT_NEAR(*up, 5 + waves.at(0.3, 0.2).height, 1e-9);
    const std::optional<double> down = waves.intersect({0.3, 0.2, 5}, {0, 0, -1});
    ASSERT_TRUE(down);
    EXPECT_NEAR(*down, 5 - waves.at(0.3, 0.2).height, 1e-9);
    // From a place on the surface outwards there is none near it.
    const Point3 on{0.3, 0.2, waves.at(0.3, 0.2).height};
    EXPECT_FALSE(waves.intersect(on, waves.at(0.3, 0.2).normal(), 0.05));
}

// All slopes of one wave lie along it.
TEST(Waves, SlopesOfOneWaveCovary) {
    WavesDesc desc;
    desc.shape = std::vector<SineWaveDesc>{
        {.amplitude = 0.1, .wavelength = 2 * k_wave_pi, .direction = 120}};
    const SlopeVariance slopes = WaterWaves(desc, 0).statistics().slopes;
    EXPECT_NEAR(slopes.total(), 0.005, 1e-12);
    EXPECT_NEAR(slopes.covariance,
                0.005 * std::cos(2 * k_wave_pi / 3) * std::sin(2 * k_wave_pi / 3), 1e-12);
}

TEST(Waves, SlopesAreComparedWithCoxAndMunks) {
    // Their fit of both together has 0.00512 in the place of the sum, 0.00508.
    EXPECT_NEAR(cox_munk_slopes(10).total(), 0.003 + 0.00512 * 10, 0.0005);
    EXPECT_NEAR(cox_munk_slopes(10).along, 0.0316, 1e-12);
    EXPECT_NEAR(cox_munk_slopes(0).across, 0.003, 1e-12);
    const WaveSpectrumDesc sea = sea_of(WaveSpectrumDesc::Model::jonswap);
    const WaterWaves waves(desc_of(sea), 0);
    const std::string text = compare_with_cox_munk(sea, waves);
    EXPECT_NE(text.find("lengths of 0.625 to 40 m"), std::string::npos) << text;
    // 7 m/s at 10 m are 2 % more at 12.5 m.
    EXPECT_NE(text.find("7.1 m/s"), std::string::npos) << text;
    EXPECT_LT(waves.statistics().slopes.total(), cox_munk_slopes(7.1).total());
}

class WaveImage : public ::testing::Test {
  protected:
    WaterWaves read(const std::filesystem::path& file, double width = 8) const {
        WavesDesc desc;
        desc.shape = HeightImageDesc{file, width};
        desc.where = "waves";
        return {desc, 0};
    }
    // Two waves along u and one along v on 64 x 32 pixels, 8 m x 4 m, in the first channel.
    static double wave(double u, double v) {
        return -0.1 + 0.05 * std::sin(2 * k_wave_pi * u / 4) * std::cos(2 * k_wave_pi * v / 4);
    }
    std::filesystem::path write(double spoilt = 0) const {
        Film film(64, 32, {0, 0, 64, 32}, {"R", "G", "B", "A"});
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x)
                film.pixel(x, y)[0] = static_cast<float>(wave((x + 0.5) / 8, 4 - (y + 0.5) / 8));
        film.pixel(3, 3)[0] += static_cast<float>(spoilt);
        const std::filesystem::path file = folder_.path() / "heights.exr";
        ExrOptions options;
        options.precision = ExrOptions::Precision::single;
        write_exr(file, film, {}, options);
        return file;
    }

    SceneFolder folder_;
};

TEST_F(WaveImage, HasItsHeightsBelowZeroToo) {
    const WaterWaves waves = read(write());
    for (const auto& [u, v] : {std::pair{0.0625, 0.0625}, {3.0, 1.7}, {-2.2, 9.1}, {7.99, 3.99}}) {
        // Central differences of 32 pixels a wave: slopes are (kd)^2 / 6 = 0.6 % too small.
        EXPECT_NEAR(waves.at(u, v).height, wave(u, v), 1e-4);
        EXPECT_NEAR(
            waves.at(u, v).slope_u,
            0.05 * k_wave_pi / 2 * std::cos(k_wave_pi * u / 2) * std::cos(k_wave_pi * v / 2), 1e-3);
        EXPECT_NEAR(waves.at(u, v).height, waves.at(u - 16, v + 4).height, 1e-12);
    }
    // The variance of a product of sines is a quarter of its amplitude's square.
    EXPECT_NEAR(waves.statistics().height_variance, 0.05 * 0.05 / 4, 1e-8);
    EXPECT_NEAR(*waves.intersect({1, 2, -3}, {0, 0, 1}), 3 + waves.at(1, 2).height, 1e-9);
}

TEST_F(WaveImage, RefusesWhatIsNoHeight) {
    const auto message = [&](const std::filesystem::path& file) {
        return message_of<InputError>([&] { read(file); });
    };
    EXPECT_NE(message(write(std::numeric_limits<double>::infinity())).find("not a finite number"),
              std::string::npos);
    EXPECT_NE(message(folder_.write("heights.png", "x")).find("convert what it was made from"),
              std::string::npos);
}

// The way to a surface is found in steps that are the shorter the steeper it is: what has slopes
// for which a ray would take minutes is refused, and says how to fix it.
TEST_F(WaveImage, RefusesSlopesThatNoWaterHas) {
    const std::filesystem::path file = write();
    EXPECT_NO_THROW(read(file, 0.1));  // of up to 6: 0.08 times as wide as the waves were
    for (const double width : {1e-2, 1e-6, 1e-300}) {
        const std::string message = message_of<InputError>([&] { read(file, width); });
        EXPECT_EQ(message.find("waves: its slopes are up to "), 0U) << message;
        EXPECT_NE(message.find("give the image a greater width"), std::string::npos) << message;
    }
}

// Whatever their keys are: each kind is there with slopes that water may have, or is refused.
TEST(Waves, AreNotTooSteepWhateverTheirKeys) {
    std::mt19937 numbers(3);
    const auto between = [&](double least, double most) {  // evenly in the logarithm
        return least * std::pow(most / least, std::uniform_real_distribution(0.0, 1.0)(numbers));
    };
    int made = 0, refused = 0;
    for (int n = 0; n < 200; ++n) {
        WavesDesc desc;
        if (n % 2 == 0) {
            desc = sum_of({{between(1e-6, 1e3), between(1e-6, 1e3), 10, 0, 0},
                           {between(1e-6, 1e3), between(1e-6, 1e3), 80, 20, 0}});
        } else {
            WaveSpectrumDesc sea = sea_of(WaveSpectrumDesc::Model::jonswap);
            sea.wind = between(0.5, 60);
            sea.fetch = between(1e-9, 1e9);
            sea.gamma = between(1, 10);
            sea.spreading = between(0.5, 1000);
            sea.tile = between(1e-6, 1e6);
            sea.resolution = 16;
            desc = desc_of(sea);
        }
        try {
            const WaterWaves waves(desc, 0);
            ++made;
            EXPECT_LE(waves.steepest(), 30);
            for (const double u : {0.0, 0.3, 1.7})
                EXPECT_LE(std::hypot(waves.at(u, 0.1).slope_u, waves.at(u, 0.1).slope_v), 30);
        } catch (const InputError&) {
            ++refused;
        }
    }
    EXPECT_GT(made, 20);
    EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace uw::test
