// ctest labels: analytic
// Where the sun stands, and how bright it is.
#include "core/light/sun.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/base/vector_math.h"
#include "core/image/spectral_bands.h"

namespace uw::test {
namespace {

/// Positions by NREL's Solar Position Algorithm (Reda and Andreas 2004, to 0.0003 degrees): its
/// worked example, and places computed by pvlib 0.11, solarposition.spa_python.
struct KnownSun {
    std::string place;
    double unix_time, latitude, longitude;
    double azimuth, elevation;  // topocentric, without refraction [degrees]
};

// 2003-10-17T19:30:30Z, 2021-06-21T12:00:00Z and 2021-12-21T09:30:00Z.
constexpr double k_example = 1066419030, k_june = 1624276800, k_december = 1640079000;

const std::array<KnownSun, 10> k_suns{{
    {"Golden", k_example, 39.742476, -105.1786, 194.340241, 39.872046},
    {"Reykjavik", k_june, 64.1466, -21.9426, 149.338091, 46.702268},
    {"Berlin", k_june, 52.52, 13.405, 203.723049, 59.285657},
    {"Berlin", k_december, 52.52, 13.405, 157.982911, 11.293283},
    {"Davis", k_december, 38.5449, -121.7405, 56.275318, -66.452193},
    {"Delhi", k_june, 28.6139, 77.209, 285.544832, 22.031291},
    {"Delhi", k_december, 28.6139, 77.209, 220.840757, 25.139617},
    {"Nairobi", k_june, -1.2921, 36.8219, 307.296059, 46.861904},
    {"Nairobi", k_december, -1.2921, 36.8219, 179.504172, 67.853069},
    {"Christchurch", k_december, -43.5321, 172.6362, 220.937996, -11.620362},
}};

TEST(Sun, StandsWhereTheSolarPositionAlgorithmSays) {
    for (const KnownSun& known : k_suns) {
        const SunPosition sun = sun_position(known.unix_time, known.latitude, known.longitude);
        EXPECT_NEAR(sun.elevation, known.elevation, 0.01) << known.place;
        // On the sky, as azimuths are worth less the higher the sun stands.
        EXPECT_NEAR((sun.azimuth - known.azimuth) * std::cos(known.elevation * k_degree), 0, 0.01)
            << known.place;
    }
    // The example's distance.
    EXPECT_NEAR(sun_position(k_example, 0, 0).distance, 0.9965423, 1e-4);
}

TEST(Sun, IsRefractedByTheAir) {
    // Meeus, example 16.a: the sun's upper limb at 33.246' is seen 24.618' higher.
    SunPosition sun;
    sun.elevation = 0.5541;
    EXPECT_NEAR(sun.apparent_elevation() - 0.5541, 24.618 / 60, 0.001);
    sun.elevation = 90;
    EXPECT_NEAR(sun.apparent_elevation(), 90, 1e-4);
    sun.elevation = -0.575;  // the sun has set when it is seen at the horizon
    EXPECT_NEAR(sun.apparent_elevation(), 0, 0.01);
    sun.elevation = -20;
    EXPECT_EQ(sun.apparent_elevation(), -20);
}

TEST(Sun, ShinesThroughMoreAirTheLowerItStands) {
    // Kasten and Young 1989, by zenith angles of 20, 40 and 70 degrees.
    EXPECT_NEAR(air_mass(70), 1.0637, 1e-4);
    EXPECT_NEAR(air_mass(50), 1.3042, 1e-4);
    EXPECT_NEAR(air_mass(20), 2.9031, 1e-4);
    EXPECT_NEAR(air_mass(0), 37.92, 0.01);
}

TEST(Sun, HasABlackbodysLightLessWhatTheAirTakes) {
    const std::array bands_nm{600.0, 550.0, 500.0, 450.0};
    constexpr double k_elevation = 35, k_turbidity = 3, k_distance = 1.01;
    const Spectrum found = direct_sun_irradiance(k_elevation, k_turbidity, k_distance, bands_nm);
    for (std::size_t band = 0; band < bands_nm.size(); ++band) {
        // Planck's law, as irradiance of a sphere of the sun's size and distance: E = pi B (R /
        // d)^2, with (R / d)^2 = total / (sigma T^4).
        const double metres = bands_nm[band] * 1e-9;
        const double exponent = 6.62607015e-34 * 299792458.0 / (metres * 1.380649e-23 * 5772);
        const double radiance = 2 * 6.62607015e-34 * std::pow(299792458.0, 2) /
                                std::pow(metres, 5) / std::expm1(exponent);
        const double size = 1361 / (5.670374419e-8 * std::pow(5772, 4)) / (k_distance * k_distance);
        const double above = std::numbers::pi * radiance * size * 1e-9 * 50;  // in a band of 50 nm
        const double micrometres = bands_nm[band] / 1000;
        const double dimmed = std::exp(-air_mass(k_elevation) *
                                       (0.008735 * std::pow(micrometres, -4.08) +
                                        (0.04608 * 3 - 0.04586) * std::pow(micrometres, -1.3)));
        // Planck's law is averaged over the band, in which it curves: 0.3 %.
        EXPECT_NEAR(found[band], above * dimmed, 0.003 * found[band]);
    }
    EXPECT_EQ(found[4], 0);
    EXPECT_EQ(direct_sun_irradiance(-0.1, 3, 1, bands_nm), Spectrum());
    const std::array one_band{550.0};
    EXPECT_THROW(direct_sun_irradiance(40, 3, 1, one_band), std::invalid_argument);
}

}  // namespace
}  // namespace uw::test
