#pragma once

namespace uw {

/// The position of the sun in the sky.
struct SunPosition {
    double azimuth = 0;    ///< clockwise from north, seen from above [degrees], 0..360
    double elevation = 0;  ///< of its centre above the horizon, without refraction [degrees]

    /// The elevation at which it is seen through a standard atmosphere (101 kPa, 10 degrees
    /// Celsius) [degrees]: Saemundsson 1986, as in Meeus 1998, eq. 16.4. Below -1 degrees there is
    /// no refraction to speak of, and none is added.
    double apparent_elevation() const;
};

/// The sun's position at `unix_time`, seconds since 1970-01-01T00:00:00 UTC, at a geodetic
/// `latitude`, -90..90, and `longitude`, eastward, -180..180 [degrees]. Meeus, Astronomical
/// Algorithms, 2nd edition 1998, chapters 12, 13 and 25 ("low accuracy"), as NOAA's solar
/// calculator has it: to 0.01 degrees from 1900 to 2100. Parallax, 0.0024 degrees at most, is left
/// out.
SunPosition sun_position(double unix_time, double latitude, double longitude);

}  // namespace uw
