// ctest labels: analytic
// The light of the sky: its models, what they are scaled to, and the directions that stand for it.
#include "core/light/sky.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/image/film.h"
#include "core/image/image_file.h"
#include "core/image/spectral_bands.h"
#include "tests/support/adaptive_quadrature.h"
#include "tests/support/fresnel_by_angles.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw::test {
namespace {

constexpr double k_pi = std::numbers::pi;
constexpr std::array k_sky_bands_nm{620.0, 540.0, 450.0};
constexpr double k_index = 1.34;

SkyDesc sky_of(SkyDesc::Model model) {
    SkyDesc desc;
    desc.model = model;
    desc.irradiance = PerBand{1, 2, 3};
    desc.where = "sky";
    return desc;
}

SkyDesc clear_sky(double azimuth, double elevation, double turbidity = 3) {
    SkyDesc desc = sky_of(SkyDesc::Model::clear);
    desc.irradiance.reset();
    desc.sun = SunAnglesDesc{azimuth, elevation};
    desc.turbidity = turbidity;
    return desc;
}

Sky made(const SkyDesc& desc) {
    return {desc, {0, 1, 0}, k_sky_bands_nm};
}

/// Towards the sky at these angles from the zenith and, counterclockwise, from east [rad].
Vector3 towards(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// int L f(theta) dOmega over the sky, in one band.
double over_the_sky(const Sky& sky, std::size_t band, const std::function<double(double)>& f) {
    // The azimuth begins at the sun, where the radiance has its cusp.
    const double first = sky.sun() ? std::atan2(sky.sun()->y, sky.sun()->x) : 0;
    const double edge = sky.sun() ? std::acos(sky.sun()->z) : 0.5;
    const double scale = sky.irradiance()[band];
    const auto ring = [&](double theta) {
        const double mean = AdaptiveQuadrature::integrate(
            [&](double phi) { return sky.radiance(towards(theta, first + phi))[band] / scale; }, 0,
            k_pi, 1e-6);
        return 2 * scale * mean * std::sin(theta) * f(theta);
    };
    const double tolerance = 1e-6 * scale;
    return AdaptiveQuadrature::integrate(ring, 0, edge, tolerance) +
           AdaptiveQuadrature::integrate(ring, edge, 0.5 * k_pi - 1e-9, tolerance);
}

double refracted_cosine(double theta) {
    return std::sqrt(1 - std::pow(std::sin(theta) / k_index, 2));
}

double transmitted(double theta) {
    return theta < 1e-6 ? 1 - std::pow((k_index - 1) / (k_index + 1), 2)
                        : fresnel_by_angles(theta, 1, k_index).mean();
}

std::vector<SkyDesc> skies() {
    std::vector<SkyDesc> all{sky_of(SkyDesc::Model::uniform), sky_of(SkyDesc::Model::overcast),
                             clear_sky(120, 35), clear_sky(-30, 70, 6), clear_sky(80, 3, 2)};
    all.push_back(clear_sky(200, 50));
    all.back().irradiance = PerBand{0.5, 0.7, 1.1};
    return all;
}

TEST(Sky, UniformAndOvercastSkiesHaveTheirClosedForms) {
    const Sky uniform = made(sky_of(SkyDesc::Model::uniform));
    const Sky overcast = made(sky_of(SkyDesc::Model::overcast));
    for (std::size_t band = 0; band < 3; ++band) {
        const double irradiance = static_cast<double>(band) + 1;
        EXPECT_NEAR(uniform.irradiance()[band], irradiance, 1e-12 * irradiance);
        EXPECT_NEAR(overcast.irradiance()[band], irradiance, 1e-12 * irradiance);
        for (const double theta : {0.0, 0.3, 1.1, 1.57}) {
            const Vector3 direction = towards(theta, 4);
            EXPECT_NEAR(uniform.radiance(direction)[band], irradiance / k_pi, 1e-12);
            EXPECT_NEAR(overcast.radiance(direction)[band],
                        irradiance * 9 / (7 * k_pi) * (1 + 2 * std::cos(theta)) / 3, 1e-12);
        }
        EXPECT_EQ(uniform.radiance({0.6, 0, -0.8})[band], 0);
    }
    const Sky black = made(sky_of(SkyDesc::Model::black));
    EXPECT_EQ(black.irradiance(), Spectrum());
    EXPECT_EQ(black.radiance({0, 0, 1}), Spectrum());
    EXPECT_TRUE(black.directions(32, k_index).empty());
}

TEST(Sky, HasTheIrradianceThatItSays) {
    for (const SkyDesc& desc : skies()) {
        const Sky sky = made(desc);
        for (const std::size_t band : {0U, 2U}) {
            const double irradiance = sky.irradiance()[band];
            if (desc.irradiance) {
                EXPECT_NEAR(irradiance, (*desc.irradiance)[band], 1e-12);
            }
            // The sky's own quadrature crosses the cusp at the sun with a step of 0.02 rad.
            EXPECT_NEAR(over_the_sky(sky, band, [](double theta) { return std::cos(theta); }),
                        irradiance, 1e-4 * irradiance);
        }
    }
}

TEST(Sky, DaylightOfD65IsTheCiesIlluminant) {
    // CIE 15: the chromaticity of daylight of 6504 K.
    constexpr double k_kilokelvin = 6.504;
    const double x = 0.244063 + 0.09911 / k_kilokelvin + 2.9678 / std::pow(k_kilokelvin, 2) -
                     4.6070 / std::pow(k_kilokelvin, 3);
    const double y = -3 * x * x + 2.870 * x - 0.275;
    const SampledCurve daylight = daylight_spectrum(x, y);
    const SampledCurve d65 =
        read_embedded_table("cie_illuminant_d65_5nm.csv").curve("wavelength_nm", "relative_power");
    for (std::size_t i = 0; i < d65.x.size(); ++i)
        // The table's M1 and M2 are rounded to three decimals: 0.0005 of S1 <= 46 and S2 <= 10.
        EXPECT_NEAR(daylight.value(d65.x[i]), d65.y[i], 0.05) << d65.x[i];
}

TEST(Sky, DaylightHasItsChromaticity) {
    for (const auto& [x, y] : {std::pair{0.25, 0.26}, {0.28, 0.29}, {0.32, 0.33}, {0.38, 0.38}}) {
        const SampledCurve daylight = daylight_spectrum(x, y);
        Xyz sum;
        for (double nm = 360; nm <= 830; nm += 1) {
            const Xyz at = cie1931_matching_functions(nm);
            sum = {sum.x + at.x * daylight.value(nm), sum.y + at.y * daylight.value(nm),
                   sum.z + at.z * daylight.value(nm)};
        }
        const double all = sum.x + sum.y + sum.z;
        // M1 and M2 are formulas with four decimals.
        EXPECT_NEAR(sum.x / all, x, 1e-3);
        EXPECT_NEAR(sum.y / all, y, 1e-3);
    }
}

// Preetham's equations once more, written out for one quantity at a time.
double perez(double cosine, double gamma, double a, double b, double c, double d, double e) {
    return (1 + a * std::exp(b / cosine)) *
           (1 + c * std::exp(d * gamma) + e * std::pow(std::cos(gamma), 2));
}

TEST(Sky, ClearSkyHasPreethamsLuminanceAndColour) {
    constexpr double k_turbidity = 3, k_elevation = 40;
    const double sun_angle = (90 - k_elevation) * k_degree;
    // 32 bands from 384 to 756 nm: all that is seen, in steps of 12 nm.
    std::vector<double> bands;
    for (int i = 0; i < 32; ++i) bands.push_back(384 + 12 * i);
    const Sky sky(clear_sky(90, k_elevation, k_turbidity), {0, 1, 0}, bands);
    // Sun in the east: [T, 1] (A, B, C, D, E) of the paper's appendix A.2, at T = 3.
    const auto luminance = [](double cosine, double gamma) {
        return perez(cosine, gamma, 0.1787 * 3 - 1.4630, -0.3554 * 3 + 0.4275, -0.0227 * 3 + 5.3251,
                     0.1206 * 3 - 2.5771, -0.0670 * 3 + 0.3703);
    };
    const auto chroma_x = [](double cosine, double gamma) {
        return perez(cosine, gamma, -0.0193 * 3 - 0.2592, -0.0665 * 3 + 0.0008,
                     -0.0004 * 3 + 0.2125, -0.0641 * 3 - 0.8989, -0.0033 * 3 + 0.0452);
    };
    const auto chroma_y = [](double cosine, double gamma) {
        return perez(cosine, gamma, -0.0167 * 3 - 0.2608, -0.0950 * 3 + 0.0092,
                     -0.0079 * 3 + 0.2102, -0.0441 * 3 - 1.6537, -0.0109 * 3 + 0.0529);
    };
    const double chi = (4.0 / 9 - 3.0 / 120) * (k_pi - 2 * sun_angle);
    const double zenith = 1000 * ((4.0453 * 3 - 4.9710) * std::tan(chi) - 0.2155 * 3 + 2.4192);
    const double s = sun_angle, s2 = s * s, s3 = s2 * s;
    const double zenith_x = 9 * (0.00166 * s3 - 0.00375 * s2 + 0.00209 * s) +
                            3 * (-0.02903 * s3 + 0.06377 * s2 - 0.03202 * s + 0.00394) +
                            (0.11693 * s3 - 0.21196 * s2 + 0.06052 * s + 0.25886);
    const double zenith_y = 9 * (0.00275 * s3 - 0.00610 * s2 + 0.00317 * s) +
                            3 * (-0.04214 * s3 + 0.08970 * s2 - 0.04153 * s + 0.00516) +
                            (0.15346 * s3 - 0.26756 * s2 + 0.06670 * s + 0.26688);
    for (const auto& [theta, phi] : {std::pair{0.0, 0.0}, {0.5, 0.3}, {1.2, 2.0}, {1.5, -1.0}}) {
        const Vector3 direction = towards(theta, phi);
        const double gamma = std::acos(direction.x * std::cos(k_elevation * k_degree) +
                                       direction.z * std::sin(k_elevation * k_degree));
        const Spectrum radiance = sky.radiance(direction);
        Xyz seen;
        const std::vector<BandInterval> intervals = band_intervals(bands);
        for (std::size_t b = 0; b < bands.size(); ++b) {
            const Xyz mean = mean_matching_functions(intervals[b].begin, intervals[b].end);
            seen = {seen.x + mean.x * radiance[b], seen.y + mean.y * radiance[b],
                    seen.z + mean.z * radiance[b]};
        }
        const double all = seen.x + seen.y + seen.z;
        // Bands see the spectrum's mean over 12 nm, by which X, Y and Z change by 0.3 %.
        const double cosine = std::cos(theta);
        const double expected = zenith * luminance(cosine, gamma) / luminance(1, sun_angle);
        EXPECT_NEAR(683 * seen.y, expected, 0.004 * expected);
        EXPECT_NEAR(seen.x / all, zenith_x * chroma_x(cosine, gamma) / chroma_x(1, sun_angle),
                    0.002);
        EXPECT_NEAR(seen.y / all, zenith_y * chroma_y(cosine, gamma) / chroma_y(1, sun_angle),
                    0.002);
    }
}

TEST(Sky, LuxScaleAClearSkyAsAWhole) {
    SkyDesc desc = clear_sky(10, 50);
    const Sky own = made(desc);
    desc.lux = 1000;
    const Sky sky = made(desc);
    const double factor = sky.irradiance()[0] / own.irradiance()[0];
    for (std::size_t band = 0; band < 3; ++band)
        EXPECT_NEAR(sky.irradiance()[band], factor * own.irradiance()[band], 1e-12);
    // Its illuminance by bands that cover all that is seen.
    std::vector<double> bands;
    for (int i = 0; i < 32; ++i) bands.push_back(384 + 12 * i);
    const Spectrum irradiance = Sky(desc, {0, 1, 0}, bands).irradiance();
    const std::vector<BandInterval> intervals = band_intervals(bands);
    double lux = 0;
    for (std::size_t b = 0; b < bands.size(); ++b)
        lux +=
            683 * irradiance[b] * mean_matching_functions(intervals[b].begin, intervals[b].end).y;
    EXPECT_NEAR(lux, 1000, 4);  // as above
}

TEST(Sky, SpectraMakeWattsOfLux) {
    SkyDesc desc = sky_of(SkyDesc::Model::overcast);
    desc.irradiance.reset();
    desc.lux = 10000;
    desc.spectrum = LampSpectrumDesc{};
    desc.spectrum->type = LampSpectrumDesc::Type::d65;
    const LampSpectrum d65 = make_lamp_spectrum(*desc.spectrum);
    const double watts = 10000 / luminous_efficacy(d65);
    const std::vector<BandInterval> intervals = band_intervals(k_sky_bands_nm);
    for (std::size_t band = 0; band < 3; ++band)
        EXPECT_NEAR(made(desc).irradiance()[band], band_values(d65, watts, intervals)[band], 1e-9);
    desc.irradiance = PerBand{watts};
    desc.lux.reset();
    EXPECT_NEAR(made(desc).irradiance()[1], band_values(d65, watts, intervals)[1], 1e-9);
    const std::array one_band{550.0};
    EXPECT_NE(message_of<InputError>([&] {
                  Sky(desc, {0, 1, 0}, one_band);
              }).find("single band"),
              std::string::npos);
}

TEST(Sky, StandsInTheWorldAsItsSunDoes) {
    // Up is y, and north -z: the sun in the south-east at 30 degrees.
    const Sky sky = made(clear_sky(135, 30));
    const Vector3 sun = sky.world_from_sky() * *sky.sun();
    const double level = std::cos(30 * k_degree);
    EXPECT_NEAR(sun.x, level * std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(sun.y, 0.5, 1e-12);
    EXPECT_NEAR(sun.z, level * std::sqrt(0.5), 1e-12);
    SkyDesc by_light = clear_sky(0, 0);
    by_light.sun = SunDirectionDesc{-sun};
    EXPECT_NEAR(glm::length(*made(by_light).sun() - *sky.sun()), 0, 1e-12);
    // Its brightest direction is the sun's, and both sides of it are the same.
    const double at_sun = sky.radiance(*sky.sun())[2];
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> uniform(0, 1);
    const double azimuth = std::atan2(sky.sun()->y, sky.sun()->x);
    for (int n = 0; n < 100; ++n) {
        const double theta = 1.55 * uniform(rng), phi = k_pi * uniform(rng);
        const Spectrum left = sky.radiance(towards(theta, azimuth + phi));
        EXPECT_LE(left[2], at_sun);
        for (std::size_t band = 0; band < 3; ++band)
            EXPECT_NEAR(left[band], sky.radiance(towards(theta, azimuth - phi))[band],
                        1e-9 * at_sun);
    }
    // Where up is z, north is y; any other may be given, of any slope.
    EXPECT_EQ(world_from_sky({0, 0, 1}, {}, ""), Matrix3(1.0));
    const Matrix3 turned = world_from_sky({0, 0, 1}, Vector3{1, 0, 5}, "");
    EXPECT_NEAR(glm::length(turned * Vector3(0, 1, 0) - Vector3(1, 0, 0)), 0, 1e-12);
    EXPECT_NEAR(glm::length(turned * Vector3(1, 0, 0) - Vector3(0, -1, 0)), 0, 1e-12);
    EXPECT_THROW(world_from_sky({0, 0, 1}, Vector3{0, 0, -2}, "sky"), InputError);
    by_light.sun = SunDirectionDesc{{0, 1, 0}};
    EXPECT_NE(message_of<InputError>([&] { made(by_light); }).find("90.0 degrees below"),
              std::string::npos);
}

TEST(Sky, DirectionsGiveTheIrradiancesBelowFlatWater) {
    for (const SkyDesc& desc : skies()) {
        const Sky sky = made(desc);
        for (const std::size_t band : {0U, 1U, 2U}) {
            const double plane = over_the_sky(
                sky, band, [](double theta) { return transmitted(theta) * std::cos(theta); });
            const double scalar = over_the_sky(sky, band, [](double theta) {
                return transmitted(theta) * std::cos(theta) / refracted_cosine(theta);
            });
            // One optical depth down, of absorption alone.
            const double deep = over_the_sky(sky, band, [](double theta) {
                return transmitted(theta) * std::cos(theta) *
                       std::exp(-1 / refracted_cosine(theta));
            });
            for (const int count : {2, 7, 32, 100, 1024}) {
                const std::vector<SkyDirection> directions = sky.directions(count, k_index);
                ASSERT_EQ(directions.size(), static_cast<std::size_t>(count));
                double found_plane = 0, found_scalar = 0, found_deep = 0, solid_angle = 0;
                for (const SkyDirection& direction : directions) {
                    EXPECT_NEAR(glm::length(direction.towards), 1, 1e-12);
                    const double theta = std::acos(direction.towards.z);
                    const double cosine = refracted_cosine(theta);
                    const double irradiance = direction.normal_irradiance()[band] *
                                              direction.towards.z * transmitted(theta);
                    found_plane += irradiance;
                    found_scalar += irradiance / cosine;
                    found_deep += irradiance * std::exp(-1 / cosine);
                    solid_angle += direction.solid_angle;
                }
                EXPECT_NEAR(solid_angle, 2 * k_pi, 1e-9);
                // The quadrature's error, as above.
                EXPECT_NEAR(found_plane, plane, 1e-4 * plane);
                // Each part stands where all bands together want it: a band by itself is off by as
                // much as the sky's colour changes within a part.
                const bool is_grey = desc.model != SkyDesc::Model::clear;
                const double change = count < 32 ? 0.02 : 0.005;
                EXPECT_NEAR(found_scalar, scalar, (is_grey ? 1e-4 : change) * scalar)
                    << count << " " << band;
                // Half of the exponential's curvature times the variance of 1 / cosine in a part,
                // 1 to 1.5 in all of the sky.
                if (count >= 32) {
                    EXPECT_NEAR(found_deep, deep, 0.01 * deep) << count << " " << band;
                }
            }
        }
    }
}

TEST(Sky, DirectionsShareTheIrradianceAlike) {
    for (const SkyDesc& desc : skies()) {
        const Sky sky = made(desc);
        const std::vector<SkyDirection> directions = sky.directions(32, k_index);
        Spectrum all;
        for (const SkyDirection& direction : directions)
            all += direction.normal_irradiance() * direction.towards.z *
                   transmitted(std::acos(direction.towards.z));
        for (const SkyDirection& direction : directions) {
            double fraction = 0;
            for (std::size_t band = 0; band < 3; ++band)
                fraction += direction.normal_irradiance()[band] / all[band] / 3;
            fraction *= direction.towards.z * transmitted(std::acos(direction.towards.z));
            // Parts end where a node of 128 x 256 does: the tenth part of a row or so.
            EXPECT_NEAR(fraction, 1.0 / 32, 0.15 / 32);
        }
        // With the index of air they give the irradiance above the water.
        double above = 0;
        for (const SkyDirection& direction : sky.directions(32, 1))
            above += direction.normal_irradiance()[1] * direction.towards.z;
        EXPECT_NEAR(above, sky.irradiance()[1], 1e-9 * above);
    }
}

TEST(Sky, OneDirectionStandsForAnEvenSky) {
    const Sky sky = made(sky_of(SkyDesc::Model::uniform));
    const std::vector<SkyDirection> one = sky.directions(1, 1);
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(one[0].towards, Vector3(0, 0, 1));
    EXPECT_NEAR(one[0].normal_irradiance()[2], 3, 1e-12);
}

TEST(Sky, WaterTransmitsAsFresnelSays) {
    EXPECT_NEAR(transmittance_into_water(1, 1.34), 1 - std::pow(0.34 / 2.34, 2), 1e-12);
    for (const double degrees : {1.0, 30.0, 53.2, 80.0, 89.9})
        EXPECT_NEAR(transmittance_into_water(std::cos(degrees * k_degree), 1.34),
                    fresnel_by_angles(degrees * k_degree, 1, 1.34).mean(), 1e-12);
    EXPECT_NEAR(transmittance_into_water(0, 1.34), 0, 1e-12);
    EXPECT_NEAR(transmittance_into_water(0.1, 1), 1, 1e-12);
}

TEST(Sky, StandsByTheClock) {
    // Berlin at noon, UTC: by NREL's Solar Position Algorithm 203.723, 59.296 with refraction.
    SkyDesc desc = clear_sky(0, 0);
    desc.sun = SunTimeDesc{1624276800, 52.52, 13.405};
    const Sky by_time = made(desc), by_angles = made(clear_sky(203.723, 59.296));
    EXPECT_NEAR(glm::length(*by_time.sun() - *by_angles.sun()), 0, 0.01 * k_degree);
    desc.sun = SunTimeDesc{1624276800 - 43200, 52.52, 13.405};
    EXPECT_NE(message_of<InputError>([&] { made(desc); }).find("below the horizon"),
              std::string::npos);
}

class Panorama : public ::testing::Test {
  protected:
    /// An image of `width` times half as many pixels with these R, G and B by azimuth from north
    /// and elevation [rad].
    template <class Colour>
    SkyDesc write(int width, const Colour& colour) const {
        const int height = width / 2;
        Film film(width, height, {0, 0, width, height}, {"R", "G", "B", "A"});
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const std::array<double, 3> rgb = colour((x + 0.5) / width * 2 * k_pi - k_pi,
                                                         0.5 * k_pi - (y + 0.5) / height * k_pi);
                for (std::size_t c = 0; c < 3; ++c)
                    film.pixel(x, y)[c] = static_cast<float>(rgb[c]);
                film.pixel(x, y)[k_alpha] = 1;
            }
        SkyDesc desc;
        desc.model = SkyDesc::Model::panorama;
        // What was read is not replaced.
        desc.file = folder_.path() / ("sky" + std::to_string(written_++) + ".exr");
        desc.where = "sky";
        ExrOptions options;
        options.precision = ExrOptions::Precision::single;
        write_exr(desc.file, film, {}, options);
        return desc;
    }
    /// Brighter than 1, and brightest in the east.
    static std::array<double, 3> smooth(double azimuth, double elevation) {
        const double east = std::sin(azimuth) * std::cos(elevation);
        return {3 + 2 * east, 2, 1 + std::sin(elevation)};
    }

    SceneFolder folder_;
    mutable int written_ = 0;
};

TEST_F(Panorama, HasItsLightWhereTheImageHasIt) {
    const Sky sky = made(write(512, smooth));
    for (const auto& [azimuth, elevation] : {std::pair{0.3, 0.5}, {-2.0, 0.02}, {3.13, 1.2}}) {
        const Vector3 direction{std::cos(elevation) * std::sin(azimuth),
                                std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
        // Bilinear between pixels of 0.012 rad.
        for (std::size_t band = 0; band < 3; ++band)
            EXPECT_NEAR(sky.radiance(direction)[band], smooth(azimuth, elevation)[band], 1e-3);
    }
    // int cos theta dOmega = pi, int cos^2 theta dOmega = 2 pi / 3; the east cancels.
    EXPECT_NEAR(sky.irradiance()[0], 3 * k_pi, 1e-4);
    EXPECT_NEAR(sky.irradiance()[1], 2 * k_pi, 1e-4);
    EXPECT_NEAR(sky.irradiance()[2], k_pi + 2 * k_pi / 3, 1e-3);
    // Turned by a quarter, what was in the east is in the south.
    SkyDesc turned = write(512, smooth);
    turned.rotate = 90;
    EXPECT_NEAR(made(turned).radiance(glm::normalize(Vector3(0, -1, 0.1)))[0],
                sky.radiance(glm::normalize(Vector3(1, 0, 0.1)))[0], 1e-9);
    turned.irradiance = PerBand{5, 6, 7};
    EXPECT_NEAR(made(turned).irradiance()[2], 7, 1e-12);
    // Its directions carry its light, to the side that it comes from.
    Vector3 vector(0);
    for (const SkyDirection& direction : sky.directions(64, 1))
        vector += direction.normal_irradiance()[0] * direction.towards;
    EXPECT_NEAR(vector.z, 3 * k_pi, 1e-3);
    // int (3 + 2 e) e dOmega = 2 int e^2 dOmega = 4 pi / 3, and 0 to the north. Parts are as wide
    // as 0.4 rad, over which directions are not parallel: cos 0.2 on average.
    EXPECT_NEAR(vector.x, 4 * k_pi / 3, 0.05 * 4 * k_pi / 3);
    EXPECT_NEAR(vector.y, 0, 0.01);
}

TEST_F(Panorama, LosesNoSmallSun) {
    // One pixel of 2048 x 1024 that is as bright as half of the sky: squares of 2 x 2 are summed.
    int lit = 0;
    const auto colour = [&](double azimuth, double elevation) -> std::array<double, 3> {
        const double pixel = 2 * k_pi / 2048;
        const bool is_sun =
            std::abs(azimuth - 1) < 0.5 * pixel && std::abs(elevation - 0.7) < 0.5 * pixel;
        lit += is_sun;
        return is_sun ? std::array<double, 3>{1e6, 1e6, 1e6} : std::array<double, 3>{1, 1, 1};
    };
    const Sky sky = made(write(2048, colour));
    ASSERT_EQ(lit, 1);
    const double pixel = 2 * k_pi / 2048;
    // cos theta dOmega of that pixel, whose centre is at most half a pixel from there.
    const double sun = 1e6 * pixel * pixel * std::cos(0.7) * std::sin(0.7);
    EXPECT_NEAR(sky.irradiance()[1], k_pi + sun, 1e-3 * sun);
    // Nearly half of the directions are wanted for it, and one has all of it.
    const std::vector<SkyDirection> directions = sky.directions(32, k_index);
    EXPECT_LT(directions.size(), 32U);
    double most = 0;
    for (const SkyDirection& direction : directions)
        most = std::max(most, direction.normal_irradiance()[1] * direction.towards.z);
    EXPECT_NEAR(most, sun, 0.01 * sun);
}

TEST_F(Panorama, RefusesWhatIsNone) {
    const auto message = [&](const SkyDesc& desc) {
        return message_of<InputError>([&] { made(desc); });
    };
    SkyDesc desc = write(64, [](double, double) {
        return std::array<double, 3>{std::numeric_limits<double>::quiet_NaN(), 0, 0};
    });
    EXPECT_NE(message(desc).find("not a finite number"), std::string::npos);
    Film square(32, 32, {0, 0, 32, 32}, {"R", "G", "B", "A"});
    desc.file = folder_.path() / "square.exr";
    write_exr(desc.file, square, {}, {});
    EXPECT_NE(message(desc).find("twice as wide as high"), std::string::npos);
    desc.file = folder_.write("sky.png", "x");
    EXPECT_NE(message(desc).find("convert what it was made from"), std::string::npos);
    // Light that is asked for in a band must be in the image.
    desc = write(64, [](double, double) { return std::array<double, 3>{1, 0, 1}; });
    desc.irradiance = PerBand{1, 1, 1};
    EXPECT_NE(message(desc).find("no light of 540 nm"), std::string::npos);
}

}  // namespace
}  // namespace uw::test
