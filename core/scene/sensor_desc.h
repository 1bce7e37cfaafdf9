#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"

namespace uw {

/// A camera's sensor as inert data, by the terms of EMVA standard 1288 (docs/camera-image.md).

/// The colours to which the pixels of a sensor respond: all light (mono), one of three by a Bayer
/// pattern, named by its first two rows, or all three.
enum class SensorMosaic : std::uint8_t { mono, rggb, bggr, grbg, gbrg, three };

/// Their names in scene files.
inline constexpr std::array<std::pair<std::string_view, SensorMosaic>, 6> k_sensor_mosaics{
    {{"mono", SensorMosaic::mono},
     {"rggb", SensorMosaic::rggb},
     {"bggr", SensorMosaic::bggr},
     {"grbg", SensorMosaic::grbg},
     {"gbrg", SensorMosaic::gbrg},
     {"three", SensorMosaic::three}}};

/// The kinds of light that a sensor tells apart: all, or red, green and blue.
constexpr std::size_t colour_count(SensorMosaic mosaic) {
    return mosaic == SensorMosaic::mono ? 1 : 3;
}
/// How many numbers a pixel of the sensor has.
constexpr std::size_t value_count(SensorMosaic mosaic) {
    return mosaic == SensorMosaic::three ? 3 : 1;
}
constexpr bool is_bayer(SensorMosaic mosaic) {
    return colour_count(mosaic) != value_count(mosaic);
}

/// Photoelectrons per photon.
struct QuantumEfficiencyDesc {
    /// Per colour (colour_count) and band, 0..1; none: the file's.
    std::array<PerBand, 3> values;
    /// CSV of wavelength_nm,r,g,b or, of a mono sensor, wavelength_nm,qe.
    std::filesystem::path file;
    bool is_per_power = false;   ///< the file's values are responses to power, not to photons
    std::optional<double> peak;  ///< the greatest efficiency: the file's values are up to a factor
    SourceLocation where;
};

/// How values between 0 and 1 are encoded.
struct ResponseCurveDesc {
    enum class Type : std::uint8_t { linear, srgb, gamma, file };
    Type type = Type::linear;
    double gamma = 1;            ///< value^(1/gamma)
    std::filesystem::path file;  ///< CSV of input,output
    SourceLocation where;
};

/// The processing of the sensor's numbers in the camera before they are stored.
struct DevelopmentDesc {
    enum class Format : std::uint8_t { png, jpeg };
    /// Gains of red, green and blue that make each image's mean grey.
    struct GreyWorld {
        friend bool operator==(const GreyWorld&, const GreyWorld&) = default;
    };
    using Gains = std::array<double, 3>;

    bool is_raw = true;  ///< the numbers are stored as they are: only the format below applies
    bool demosaic = true;
    std::variant<Gains, GreyWorld> white_balance = Gains{1, 1, 1};
    ResponseCurveDesc response;
    int bits = 8;  ///< of the image, 8 or 16
    Format format = Format::png;
    int quality = 90;  ///< of a JPEG, 1..100
};

/// A sensor behind the camera's lens.
struct SensorDesc {
    std::optional<double> exposure;     ///< [s], > 0; none: render.shutter
    std::optional<double> pixel_pitch;  ///< [m], > 0; none: that of focal lengths in m and pixels
    SensorMosaic mosaic = SensorMosaic::mono;
    QuantumEfficiencyDesc quantum_efficiency;
    bool shot_noise = true;
    std::optional<double> full_well;  ///< saturation capacity [e-], > 0; none: unlimited
    double dark_current = 0;          ///< [e-/s]
    double read_noise = 0;            ///< temporal dark noise [e- rms]
    double dsnu = 0;                  ///< dark signal nonuniformity [e- rms]
    double prnu = 0;                  ///< photo response nonuniformity, relative, rms
    std::optional<double> gain;       ///< system gain K [DN/e-], > 0; none: full well is white
    double black_level = 0;           ///< [DN]
    int bit_depth = 12;               ///< 8..16
    std::uint64_t seed = 0;           ///< of all that is random
    DevelopmentDesc image;
    SourceLocation where;

    /// The greatest digital number.
    double white_level() const { return static_cast<double>((1 << bit_depth) - 1); }
    /// The system gain K [DN/e-]. Precondition, checked by the scene reader: it or the full well is
    /// given.
    double system_gain() const {
        return gain ? *gain : (white_level() - black_level) / full_well.value();
    }
};

/// `sensor` of a camera.
SensorDesc read_sensor(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
