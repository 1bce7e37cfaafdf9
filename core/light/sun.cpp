#include "core/light/sun.h"

#include <algorithm>
#include <cmath>

#include "core/base/vector_math.h"

namespace uw {

namespace {

double sine_of_degrees(double angle) {
    return std::sin(angle * k_degree);
}
double cosine_of_degrees(double angle) {
    return std::cos(angle * k_degree);
}
/// 0..360.
double in_one_turn(double angle) {
    return angle - 360 * std::floor(angle / 360);
}

}  // namespace

double SunPosition::apparent_elevation() const {
    if (elevation < -1) return elevation;
    const double refraction =
        1.02 / std::tan((elevation + 10.3 / (elevation + 5.11)) * k_degree) / 60;
    return elevation + std::max(0.0, refraction);  // 0 at the zenith, but for rounding
}

SunPosition sun_position(double unix_time, double latitude, double longitude) {
    // Universal time replaces dynamical time: they differ by about a minute, in which the sun moves
    // by 0.001 degrees.
    const double days = unix_time / 86400 + 2440587.5 - 2451545;  // since J2000.0
    const double t = days / 36525;                                // [Julian centuries]
    const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
    const double anomaly = 357.52911 + t * (35999.05029 - t * 0.0001537);
    const double centre = (1.914602 - t * (0.004817 + t * 0.000014)) * sine_of_degrees(anomaly) +
                          (0.019993 - t * 0.000101) * sine_of_degrees(2 * anomaly) +
                          0.000289 * sine_of_degrees(3 * anomaly);
    const double node = 125.04 - 1934.136 * t;
    const double nutation = -0.00478 * sine_of_degrees(node);
    const double longitude_of_sun = mean_longitude + centre - 0.00569 + nutation;
    const double obliquity = 23.439291 - t * (0.0130042 + t * (1.64e-7 - t * 5.04e-7)) +
                             0.00256 * cosine_of_degrees(node);
    const double right_ascension =
        std::atan2(cosine_of_degrees(obliquity) * sine_of_degrees(longitude_of_sun),
                   cosine_of_degrees(longitude_of_sun));
    const double sine_of_declination =
        sine_of_degrees(obliquity) * sine_of_degrees(longitude_of_sun);
    const double cosine_of_declination = std::sqrt(1 - sine_of_declination * sine_of_declination);
    // Apparent sidereal time at Greenwich (eq. 12.4, with nutation).
    const double sidereal = 280.46061837 + 360.98564736629 * days + 0.000387933 * t * t +
                            nutation * cosine_of_degrees(obliquity);
    const double hour_angle = in_one_turn(sidereal + longitude) * k_degree - right_ascension;

    const double north = sine_of_declination * cosine_of_degrees(latitude) -
                         cosine_of_declination * std::cos(hour_angle) * sine_of_degrees(latitude);
    const double east = -cosine_of_declination * std::sin(hour_angle);
    const double up = sine_of_declination * sine_of_degrees(latitude) +
                      cosine_of_declination * std::cos(hour_angle) * cosine_of_degrees(latitude);
    SunPosition position;
    position.azimuth = in_one_turn(std::atan2(east, north) / k_degree);
    position.elevation = std::atan2(up, std::hypot(east, north)) / k_degree;
    return position;
}

}  // namespace uw
