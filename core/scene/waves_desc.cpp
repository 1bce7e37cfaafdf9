#include "core/scene/waves_desc.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>

namespace uw {

namespace {

constexpr auto k_wave_direction_hint =
    "give the direction in which waves travel in degrees, from the surface's u to its v";

SineWaveDesc read_sine(const ConfigValue& value) {
    constexpr auto k_example = "write {amplitude: 0.1, wavelength: 3, direction: 30}";
    ConfigMap map(value, {"amplitude", "wavelength", "direction", "phase", "steepness"}, k_example);
    SineWaveDesc wave;
    wave.amplitude = map.require("amplitude", k_example)
                         .positive("give half of the height from trough to crest in metres");
    wave.wavelength =
        map.require("wavelength", k_example).positive("give the distance of crests in metres");
    if (const auto direction = map.find("direction"))
        wave.direction = direction->within(-360, 360, k_wave_direction_hint);
    if (const auto phase = map.find("phase"))
        wave.phase = phase->within(-360, 360, "give the phase in degrees; 0: a crest");
    if (const auto steepness = map.find("steepness"))
        wave.steepness = steepness->within(0, 1, "give 0 for a sine to 1 for Gerstner's trochoid");
    map.finish("a wave");
    return wave;
}

std::vector<SineWaveDesc> read_sines(ConfigMap& map) {
    constexpr auto k_hint = "list its waves, such as [{amplitude: 0.1, wavelength: 3}]";
    // Beyond this the horizontal motion folds the surface over itself, so that its height is
    // undefined.
    constexpr double k_max_folding = 0.95;
    std::vector<SineWaveDesc> waves;
    double folding = 0;
    const ConfigValue list = map.require("waves", k_hint);
    for (const ConfigValue& entry : list.list(k_hint)) {
        waves.push_back(read_sine(entry));
        folding += waves.back().steepness * waves.back().amplitude * 2 * std::numbers::pi /
                   waves.back().wavelength;
    }
    // All of them are evaluated wherever a ray comes near the surface.
    constexpr std::size_t k_max_waves = 1000;
    if (waves.size() > k_max_waves)
        list.fail(
            fmt::format("has {} waves, and must not have more than {}; leave out the smallest, "
                        "or write a sea of many as type: jonswap",
                        waves.size(), k_max_waves));
    if (waves.empty()) list.fail(fmt::format("has no entry; {}", k_hint));
    if (folding > k_max_folding)
        list.fail(fmt::format(
            "the sum of steepness 2 pi amplitude / wavelength is {:.3g}, and must not be above {}, "
            "or the surface folds over itself; lower steepness or amplitudes",
            folding, k_max_folding));
    return waves;
}

WaveSpectrumDesc read_wave_spectrum(ConfigMap& map, WaveSpectrumDesc::Model model) {
    WaveSpectrumDesc spectrum;
    spectrum.model = model;
    constexpr auto k_wind_hint = "give the wind's speed in m/s, 0.5 to 60";
    spectrum.wind = map.require("wind", k_wind_hint).within(0.5, 60, k_wind_hint);
    if (const auto height = map.find("wind_height"))
        spectrum.wind_height =
            height->within(1, 100, "give the height at which the wind is measured in metres");
    if (const auto direction = map.find("direction"))
        spectrum.direction = direction->within(-360, 360, k_wave_direction_hint);
    if (model == WaveSpectrumDesc::Model::jonswap) {
        constexpr auto k_fetch_hint = "give the distance over which the wind has blown in metres";
        spectrum.fetch = map.require("fetch", k_fetch_hint).positive(k_fetch_hint);
        if (const auto gamma = map.find("gamma"))
            spectrum.gamma = gamma->within(1, 10, "give the peak enhancement, 3.3 in the mean");
    }
    if (const auto spreading = map.find("spreading"))
        spectrum.spreading = spreading->within(
            0.5, 1000, "give s of cos^2s(angle / 2): 2 for waves from all around, 25 for a swell");
    constexpr auto k_tile_hint = "give the side of the square that repeats in metres";
    spectrum.tile = map.require("tile", k_tile_hint).positive(k_tile_hint);
    if (const auto resolution = map.find("resolution")) {
        spectrum.resolution =
            resolution->integer(16, 2048, "give the number of heights along a side");
        if (spectrum.resolution % 2 != 0)
            resolution->fail(fmt::format("must be even, found {}; powers of 2 are fastest",
                                         spectrum.resolution));
    }
    if (const auto seed = map.find("seed"))
        spectrum.seed = static_cast<std::uint64_t>(seed->integer(
            0, std::numeric_limits<int>::max(), "give a whole number; another is another sea"));
    return spectrum;
}

HeightImageDesc read_height_image(ConfigMap& map, const SceneContext& context) {
    HeightImageDesc image;
    image.file = read_existing_file(
        map.require("file", "name an OpenEXR or TIFF file of heights in metres"), context);
    constexpr auto k_hint = "give the width of the whole image in metres";
    image.width = map.require("width", k_hint).positive(k_hint);
    return image;
}

}  // namespace

WavesDesc read_waves(const ConfigValue& value, const SceneContext& context) {
    enum class Type { sines, pierson_moskowitz, jonswap, image };
    constexpr auto k_example = "write {type: jonswap, wind: 6, fetch: 2000, tile: 20}";
    ConfigMap map(value,
                  {"type", "waves", "wind", "wind_height", "direction", "fetch", "gamma",
                   "spreading", "tile", "resolution", "seed", "file", "width", "depth"},
                  k_example);
    WavesDesc waves;
    waves.where = value.location();
    constexpr auto k_types = std::to_array<std::pair<std::string_view, Type>>(
        {{"sines", Type::sines},
         {"pierson-moskowitz", Type::pierson_moskowitz},
         {"jonswap", Type::jonswap},
         {"image", Type::image}});
    const ConfigValue word = map.require("type", k_example);
    const Type type = word.choice(k_types);
    if (type == Type::sines)
        waves.shape = read_sines(map);
    else if (type == Type::image)
        waves.shape = read_height_image(map, context);
    else
        waves.shape = read_wave_spectrum(map, type == Type::jonswap
                                                  ? WaveSpectrumDesc::Model::jonswap
                                                  : WaveSpectrumDesc::Model::pierson_moskowitz);
    if (type != Type::image)
        if (const auto depth = map.find("depth"))
            waves.depth = depth->positive("give the water's depth in metres, or leave it out");
    map.finish("waves of type '" + word.node().scalar + "'");
    return waves;
}

}  // namespace uw
