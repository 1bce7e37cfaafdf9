#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"

namespace uw {

/// One wave of a sum. Directions of waves are angles in the plane of the calm water, from u towards
/// v, in which they travel.
struct SineWaveDesc {
    double amplitude = 0;   ///< [m], > 0
    double wavelength = 0;  ///< [m], > 0
    double direction = 0;   ///< [degrees], -360..360
    double phase = 0;       ///< at u = v = 0 and time 0; 0: a crest [degrees], -360..360
    /// The ratio of the water's horizontal to its vertical motion, 0..1: 0 is a sine, 1 Gerstner's
    /// trochoid.
    double steepness = 0;

    friend bool operator==(const SineWaveDesc&, const SineWaveDesc&) = default;
};

/// A sea raised by wind, drawn at random by its spectrum on a square tile that repeats.
struct WaveSpectrumDesc {
    enum class Model {
        pierson_moskowitz,  ///< fully developed: Pierson and Moskowitz 1964
        jonswap,            ///< by fetch: Hasselmann et al. 1973
    };

    Model model = Model::pierson_moskowitz;
    double wind = 0;          ///< speed [m/s], 0.5..60
    double wind_height = 10;  ///< above the water at which it is measured [m], 1..100
    double direction = 0;     ///< in which it blows, as of SineWaveDesc [degrees], -360..360
    double fetch = 0;         ///< over which it has blown [m], > 0; JONSWAP alone
    double gamma = 3.3;       ///< peak enhancement, 1..10; JONSWAP alone
    double spreading = 10;    ///< s of cos^{2s}(angle / 2), 0.5..1000
    double tile = 0;          ///< side of the tile [m], > 0
    int resolution = 512;     ///< heights along a side, even, 16..2048
    std::uint64_t seed = 0;

    friend bool operator==(const WaveSpectrumDesc&, const WaveSpectrumDesc&) = default;
};

/// Heights from an image, which repeats.
struct HeightImageDesc {
    std::filesystem::path
        file;          ///< of linear floating-point values, OpenEXR or TIFF; channel 1 [m]
    double width = 0;  ///< of the whole image, along u [m], > 0; its pixels are square

    friend bool operator==(const HeightImageDesc&, const HeightImageDesc&) = default;
};

/// The shape of the water's surface, as heights above its plane. core/geometry/waves.h makes it.
struct WavesDesc {
    std::variant<std::vector<SineWaveDesc>, WaveSpectrumDesc, HeightImageDesc> shape;
    std::optional<double> depth;  ///< of the water, by which waves travel [m]; none: deep
    SourceLocation where;

    friend bool operator==(const WavesDesc&, const WavesDesc&) = default;
};

/// Waves, by `type`.
WavesDesc read_waves(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
