#pragma once

#include <span>

#include "core/base/spectrum.h"

namespace uw {

/// Angular radius of the sun's disc at the mean distance [degrees] (959.63 arc seconds, Auwers
/// 1891).
inline constexpr double k_sun_radius = 0.26656;

/// Nominal total solar irradiance [W/m^2] and effective temperature [K] (IAU 2015, resolution B3).
inline constexpr double k_solar_irradiance = 1361, k_solar_temperature = 5772;

/// The position of the sun in the sky.
struct SunPosition {
    double azimuth = 0;    ///< clockwise from north, seen from above [degrees], 0..360
    double elevation = 0;  ///< of its centre above the horizon, without refraction [degrees]
    double distance = 1;   ///< [astronomical units]

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

/// How much more air the sun's light passes at this apparent elevation [degrees], 0..90, than from
/// the zenith: Kasten and Young 1989, 38 at the horizon.
double air_mass(double apparent_elevation);

/// Irradiance of the sun's direct light on a plane that faces it, in the air at sea level [W/m^2],
/// in each band (core/image/spectral_bands.h): that of a blackbody of the sun's temperature and
/// total irradiance at this distance, dimmed by
///
/// - molecules, exp(-0.008735 lambda^-4.08 m), and
/// - aerosols, exp(-beta lambda^-1.3 m), beta = 0.04608 T - 0.04586 (lambda in micrometres, air
/// mass
///   m, turbidity T),
///
/// of Preetham, Shirley and Smits 1999, appendix A.1, at each band's wavelength. Ozone, which
/// takes up to 9 % at 600 nm with the sun at 30 degrees, water vapour, oxygen, and the lines of the
/// sun's spectrum are left out. Nothing at an apparent elevation below 0. Throws
/// std::invalid_argument for fewer than two bands, as the width of a single one is undefined.
Spectrum direct_sun_irradiance(double apparent_elevation, double turbidity, double distance,
                               std::span<const double> bands_nm);

}  // namespace uw
