// ctest labels: analytic
// Where the sun stands.
#include "core/light/sun.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "core/base/vector_math.h"

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
        // On the sky, where a difference of azimuth is shorter the higher the sun stands.
        EXPECT_NEAR((sun.azimuth - known.azimuth) * std::cos(known.elevation * k_degree), 0, 0.01)
            << known.place;
    }
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

}  // namespace
}  // namespace uw::test
