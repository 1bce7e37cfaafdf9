#include "core/scene/sensor_desc.h"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <string_view>

#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"

namespace uw {

namespace {

constexpr std::array<std::pair<std::string_view, bool>, 2> k_switch{
    {{"true", true}, {"false", false}}};
constexpr std::array<std::string_view, 3> k_colours{"r", "g", "b"};
constexpr auto k_efficiency = "give photoelectrons per photon, 0 to 1, such as 0.6";

bool is_text(const ConfigValue& value, std::string_view ending) {
    const ConfigNode& node = value.node();
    return node.kind == ConfigNode::Kind::scalar && node.scalar.ends_with(ending);
}

PerBand read_efficiencies(const ConfigValue& value, const SceneContext& context) {
    PerBand values;
    for (const ConfigValue& entry : value.per_band(context.band_count, k_efficiency))
        values.push_back(entry.within(0, 1, k_efficiency));
    return values;
}

/// With three bands, red, green and blue pixels respond to one band each.
void assign_bands(const ConfigValue& value, SensorMosaic mosaic, const SceneContext& context,
                  QuantumEfficiencyDesc& desc) {
    const PerBand values = read_efficiencies(value, context);
    if (mosaic == SensorMosaic::mono) {
        desc.values[0] = values;
        return;
    }
    if (values.size() != 3)
        value.fail(
            "only three bands can be red, green and blue themselves; give {r: [..], g: [..], "
            "b: [..]} with one number per band each, or a CSV of wavelength_nm,r,g,b");
    for (std::size_t c = 0; c < 3; ++c) {
        desc.values[c].assign(3, 0.0);
        desc.values[c][c] = values[c];
    }
}

void read_efficiency_map(const ConfigValue& value, SensorMosaic mosaic, const SceneContext& context,
                         QuantumEfficiencyDesc& desc) {
    constexpr auto k_example =
        "write {file: qe.csv}, {file: response.csv, per: power, peak: 0.6}, or {r: [..], g: [..], "
        "b: [..]}";
    ConfigMap map(value, {"file", "per", "peak", "r", "g", "b"}, k_example);
    if (const auto file = map.find("file")) {
        desc.file = read_existing_file(*file, context);
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_units{
            {{"photon", false}, {"power", true}}};
        const auto per = map.find("per");
        if (per) desc.is_per_power = per->choice(k_units);
        if (const auto peak = map.find("peak")) {
            constexpr auto k_hint = "give the greatest photoelectrons per photon, such as 0.6";
            desc.peak = peak->within(0, 1, k_hint);
            peak->positive(k_hint);
        }
        if (desc.is_per_power && !desc.peak)
            per->fail(
                "a response to power is known up to a factor; add the greatest efficiency, "
                "such as peak: 0.6");
        map.finish("a quantum efficiency with 'file'");
        return;
    }
    if (mosaic == SensorMosaic::mono)
        value.fail("a mono sensor has no colours; give one number per band, or {file: qe.csv}");
    for (std::size_t c = 0; c < 3; ++c)
        desc.values[c] = read_efficiencies(map.require(k_colours[c], k_example), context);
    map.finish("a quantum efficiency without 'file'");
}

QuantumEfficiencyDesc read_efficiency(const ConfigValue& value, SensorMosaic mosaic,
                                      const SceneContext& context) {
    QuantumEfficiencyDesc desc;
    desc.where = value.location();
    if (is_text(value, ".csv"))
        desc.file = read_existing_file(value, context);
    else if (value.node().kind == ConfigNode::Kind::map)
        read_efficiency_map(value, mosaic, context, desc);
    else
        assign_bands(value, mosaic, context, desc);
    return desc;
}

ResponseCurveDesc read_curve(const ConfigValue& value, const SceneContext& context) {
    using Type = ResponseCurveDesc::Type;
    ResponseCurveDesc curve;
    curve.where = value.location();
    if (is_text(value, ".csv")) {
        curve.type = Type::file;
        curve.file = read_existing_file(value, context);
    } else if (value.node().kind == ConfigNode::Kind::map) {
        ConfigMap map(value, {"gamma"}, "write {gamma: 2.2}");
        constexpr auto k_hint = "give the exponent, such as 2.2 for value^(1/2.2)";
        curve.type = Type::gamma;
        curve.gamma = map.require("gamma", k_hint).within(0.1, 10, k_hint);
    } else {
        constexpr std::array<std::pair<std::string_view, Type>, 2> k_types{
            {{"linear", Type::linear}, {"srgb", Type::srgb}}};
        curve.type = value.choice(k_types);
    }
    return curve;
}

std::variant<DevelopmentDesc::Gains, DevelopmentDesc::GreyWorld> read_white_balance(
    const ConfigValue& value) {
    constexpr auto k_hint = "give the gains of red, green and blue, such as [1.9, 1, 1.6]";
    if (value.node().kind == ConfigNode::Kind::scalar) {
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_words{
            {{"none", false}, {"grey-world", true}}};
        if (value.choice(k_words)) return DevelopmentDesc::GreyWorld{};
        return DevelopmentDesc::Gains{1, 1, 1};
    }
    DevelopmentDesc::Gains gains{};
    const std::vector<ConfigValue> numbers = value.list_of(3, k_hint);
    for (std::size_t c = 0; c < 3; ++c) gains[c] = numbers[c].positive(k_hint);
    return gains;
}

void read_format(ConfigMap& map, DevelopmentDesc& image) {
    using Format = DevelopmentDesc::Format;
    constexpr std::array<std::pair<std::string_view, Format>, 2> k_formats{
        {{"png", Format::png}, {"jpeg", Format::jpeg}}};
    if (const auto format = map.find("format")) image.format = format->choice(k_formats);
    const auto quality = map.find("quality");
    if (!quality) return;
    if (image.format != Format::jpeg)
        quality->fail("only JPEG loses anything; add format: jpeg, or remove this");
    image.quality = quality->integer(1, 100, "give 1 to 100, such as 90");
}

DevelopmentDesc read_development(const ConfigValue& value, const SensorDesc& sensor,
                                 const SceneContext& context) {
    DevelopmentDesc image;
    if (value.node().kind == ConfigNode::Kind::scalar) {
        constexpr std::array<std::pair<std::string_view, bool>, 1> k_words{{{"raw", true}}};
        value.choice(k_words);
        return image;
    }
    ConfigMap map(value, {"demosaic", "white_balance", "response", "bits", "format", "quality"},
                  "write raw, or {white_balance: [1.9, 1, 1.6], response: srgb, bits: 8}");
    image.is_raw = false;
    if (const auto entry = map.find("demosaic")) {
        if (!is_bayer(sensor.mosaic))
            entry->fail("this sensor has no Bayer mosaic; remove this, or set sensor.mosaic: rggb");
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_methods{
            {{"bilinear", true}, {"none", false}}};
        image.demosaic = entry->choice(k_methods);
    }
    if (const auto entry = map.find("white_balance")) {
        if (sensor.mosaic == SensorMosaic::mono)
            entry->fail("a mono sensor has no colours to balance; remove this");
        image.white_balance = read_white_balance(*entry);
    }
    if (const auto entry = map.find("response")) image.response = read_curve(*entry, context);
    read_format(map, image);
    if (const auto bits = map.find("bits")) {
        image.bits = bits->integer(8, 16, "give 8 or 16");
        if (image.bits != 8 && image.bits != 16) bits->fail("give 8 or 16");
        if (image.bits == 16 && image.format == DevelopmentDesc::Format::jpeg)
            bits->fail("a JPEG has 8 bits; write format: png, or remove this");
    }
    return image;
}

void read_noise(ConfigMap& map, SensorDesc& sensor) {
    constexpr auto k_electrons = "give a number of electrons";
    if (const auto entry = map.find("shot_noise")) sensor.shot_noise = entry->choice(k_switch);
    if (const auto entry = map.find("full_well")) sensor.full_well = entry->positive(k_electrons);
    if (const auto entry = map.find("dark_current"))
        sensor.dark_current = entry->non_negative("give electrons per second");
    if (const auto entry = map.find("read_noise"))
        sensor.read_noise = entry->non_negative(k_electrons);
    if (const auto entry = map.find("dsnu")) sensor.dsnu = entry->non_negative(k_electrons);
    if (const auto entry = map.find("prnu"))
        sensor.prnu = entry->within(0, 1, "give a fraction, such as 0.01 for 1 %");
}

void read_digits(const ConfigValue& value, ConfigMap& map, SensorDesc& sensor) {
    if (const auto entry = map.find("bit_depth"))
        sensor.bit_depth = entry->integer(8, 16, "give the bits of the converter");
    if (const auto entry = map.find("black_level"))
        sensor.black_level =
            entry->within(0, sensor.white_level() / 2, "give a digital number, such as 64");
    if (const auto entry = map.find("gain"))
        sensor.gain = entry->positive("give digital numbers per electron, such as 0.38");
    if (!sensor.gain && !sensor.full_well)
        value.fail(
            "neither 'gain' [DN/e-] nor 'full_well' [e-] is given, so that the brightness "
            "is unknown; give gain: 0.38, or full_well: 10500, which then is white");
    if (const auto entry = map.find("seed"))
        sensor.seed = static_cast<std::uint64_t>(
            entry->integer(0, std::numeric_limits<int>::max(), "give a whole number"));
}

}  // namespace

SensorDesc read_sensor(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_example =
        "write {exposure: 0.01, quantum_efficiency: 0.6, full_well: 10500, read_noise: 2.4}";
    ConfigMap map(value,
                  {"exposure", "pixel_pitch", "mosaic", "quantum_efficiency", "shot_noise",
                   "full_well", "dark_current", "read_noise", "dsnu", "prnu", "gain", "black_level",
                   "bit_depth", "seed", "image"},
                  k_example);
    SensorDesc sensor;
    sensor.where = value.location();
    if (const auto entry = map.find("exposure")) {
        constexpr auto k_hint = "give the exposure time in seconds, such as 0.01";
        sensor.exposure = entry->positive(k_hint);
        entry->within(0, 3600, k_hint);
    }
    if (const auto entry = map.find("pixel_pitch")) {
        sensor.pixel_pitch = entry->positive("give metres, such as 3.45e-6");
        if (*sensor.pixel_pitch > 1e-3)
            entry->fail(fmt::format("{} looks like micrometres; give metres, such as 3.45e-6",
                                    *sensor.pixel_pitch));
    }
    if (const auto entry = map.find("mosaic")) sensor.mosaic = entry->choice(k_sensor_mosaics);
    sensor.quantum_efficiency =
        read_efficiency(map.require("quantum_efficiency", k_efficiency), sensor.mosaic, context);
    read_noise(map, sensor);
    read_digits(value, map, sensor);
    if (const auto entry = map.find("image"))
        sensor.image = read_development(*entry, sensor, context);
    return sensor;
}

}  // namespace uw
