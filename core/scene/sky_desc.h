#pragma once

#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/lamp_desc.h"
#include "core/scene/scene_context.h"

namespace uw {

/// The sun by its position in the sky.
struct SunAnglesDesc {
    double azimuth = 0;     ///< clockwise from north, seen from above [degrees], -360..360
    double elevation = 90;  ///< of its centre above the horizon [degrees], 0..90

    friend bool operator==(const SunAnglesDesc&, const SunAnglesDesc&) = default;
};

/// The sun by the direction of its light.
struct SunDirectionDesc {
    Vector3 direction;  ///< in which its light travels in the air, world, unit

    friend bool operator==(const SunDirectionDesc&, const SunDirectionDesc&) = default;
};

/// The sun by time and place (core/light/sun.h), as seen through the air.
struct SunTimeDesc {
    double unix_time = 0;  ///< [s] since 1970-01-01T00:00:00 UTC
    double latitude = 0;   ///< geodetic, northward [degrees], -90..90
    double longitude = 0;  ///< eastward [degrees], -180..180

    friend bool operator==(const SunTimeDesc&, const SunTimeDesc&) = default;
};

/// Where the sun stands. core/light/sky.h finds the place in the sky; it does not compile unless it
/// handles all of these.
using SunPositionDesc = std::variant<SunAnglesDesc, SunDirectionDesc, SunTimeDesc>;

/// The light of the sky above the water, without that of the sun's disc.
struct SkyDesc {
    /// How its radiance depends on direction (core/light/sky.h has the equations):
    ///
    /// - uniform: the same everywhere.
    /// - black: there is none.
    /// - overcast: the CIE's, three times as bright overhead as at the horizon.
    /// - clear: Preetham, Shirley and Smits 1999, by sun and turbidity.
    /// - panorama: an image of all directions.
    enum class Model { uniform, black, overcast, clear, panorama };

    Model model = Model::uniform;
    // At most one of the next two is set, and exactly one unless the model is `black`, or `clear`
    // or `panorama`, which have a brightness of their own.
    /// Plane irradiance of a horizontal surface in the air [W/m^2]; with a spectrum, a single
    /// total.
    std::optional<PerBand> irradiance;
    /// Its illuminance [lx]; with a spectrum, unless the model is `clear`, which has its own.
    std::optional<double> lux;
    std::optional<LampSpectrumDesc> spectrum;  ///< of the irradiance
    double turbidity = 3;                      ///< of the air, 2..10; `clear` only
    std::optional<SunPositionDesc> sun;        ///< set for `clear`, and only there
    /// Of `panorama`: OpenEXR, TIFF or Radiance HDR, twice as wide as high, with azimuths from left
    /// to right and the zenith at the top. Its middle shows north, turned by `rotate`.
    std::filesystem::path file;
    double rotate = 0;  ///< of the panorama, clockwise, seen from above [degrees], -360..360
    /// Where north is, in the world, of any slope but vertical; none: the world's -z, or
    /// y where up is within 45 degrees of the world's z axis.
    std::optional<Vector3> north;
    int samples = 32;  ///< number of directions that represent it, 1..1024
    SourceLocation where;
};

/// Where the sun stands: {azimuth, elevation}, {direction} or {time, latitude, longitude}.
SunPositionDesc read_sun_position(const ConfigValue& value, const SceneContext& context);

/// A sky; the bands' number is known (SceneContext::band_count).
SkyDesc read_sky(const ConfigValue& value, const SceneContext& context);

/// Reads `sky`, above a surface that refracts, and appends its light to the scene's lamps, as one
/// called "sky". Throws InputError if that name is taken.
void append_sky(const ConfigValue& value, const SceneContext& context,
                std::vector<LampDesc>& lamps);

}  // namespace uw
