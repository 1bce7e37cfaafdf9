#include "core/scene/lamp_desc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/scene/config_value.h"
#include "core/scene/scene_context.h"
#include "core/scene/trajectory_reader.h"

namespace uw {

LampSpectrumDesc read_spectrum(const ConfigValue& value, const SceneContext& context) {
    using Type = LampSpectrumDesc::Type;
    constexpr auto k_example = "write {type: led, name: LED-B4} or {file: lamp.csv}";
    ConfigMap map(value, {"type", "temperature", "name", "file", "column"}, k_example);
    LampSpectrumDesc spectrum;
    spectrum.where = value.location();
    if (!map.has("type") && map.has("file")) {
        spectrum.type = Type::file;
        spectrum.file = read_existing_file(*map.find("file"), context);
        if (const auto column = map.find("column"))
            spectrum.column = column->text("name the column of the file");
        map.finish("a spectrum with 'file'");
        return spectrum;
    }
    const ConfigValue type = map.require("type", k_example);
    constexpr std::array<std::pair<std::string_view, Type>, 4> k_types{
        {{"flat", Type::flat},
         {"d65", Type::d65},
         {"blackbody", Type::blackbody},
         {"led", Type::led}}};
    spectrum.type = type.choice(k_types);
    if (spectrum.type == Type::blackbody) {
        constexpr auto k_hint = "give the colour temperature in kelvin, such as 5600";
        spectrum.temperature = map.require("temperature", k_hint).within(500, 100000, k_hint);
    }
    if (spectrum.type == Type::led) {
        constexpr auto k_hint = "name one of the CIE's LED illuminants, such as LED-B4";
        spectrum.name = map.require("name", k_hint).text(k_hint);
    }
    map.finish("spectrum type '" + type.node().scalar + "'");
    return spectrum;
}

namespace {

LampProfileDesc read_isotropic(ConfigMap& /*map*/, const SceneContext& /*context*/) {
    return IsotropicProfileDesc{};
}

LampProfileDesc read_spot(ConfigMap& map, const SceneContext& /*context*/) {
    SpotProfileDesc profile;
    const ConfigValue beam = map.require("beam", "give the full angle at half intensity");
    profile.beam = beam.number("give the full angle at half intensity in degrees");
    if (profile.beam <= 0 || profile.beam > 180) {
        beam.fail(
            fmt::format("must be greater than 0 and at most 180, found {}; give the full "
                        "angle at half intensity in degrees",
                        profile.beam));
    }
    if (const auto edge = map.find("edge")) {
        profile.edge = edge->non_negative("give the width of the edge in degrees");
        if (profile.edge > profile.beam) {
            edge->fail(
                fmt::format("must not be wider than the beam of {}, found {}; the light "
                            "falls from full at beam/2 - edge/2 to none at beam/2 + edge/2",
                            profile.beam, profile.edge));
        }
    }
    if (const auto falloff = map.find("falloff")) {
        using Falloff = SpotProfileDesc::Falloff;
        constexpr auto k_falloffs = std::to_array<std::pair<std::string_view, Falloff>>(
            {{"smooth", Falloff::smooth},
             {"gltf", Falloff::gltf},
             {"blender", Falloff::blender},
             {"blender-3.4", Falloff::blender_3_4}});
        profile.falloff = falloff->choice(k_falloffs);
        const bool is_blenders =
            profile.falloff == Falloff::blender || profile.falloff == Falloff::blender_3_4;
        if (is_blenders && profile.beam + profile.edge > 180)
            falloff->fail(fmt::format(
                "needs beam + edge, Blender's Size, of at most 180, found {}; make them narrower",
                profile.beam + profile.edge));
    }
    return profile;
}

LampProfileDesc read_cosine(ConfigMap& map, const SceneContext& /*context*/) {
    constexpr auto k_hint = "give the full angle at half intensity in degrees";
    return CosineProfileDesc{map.require("fwhm", k_hint).between(0, 180, k_hint)};
}

LampProfileDesc read_table_profile(ConfigMap& map, const SceneContext& /*context*/) {
    constexpr auto k_hint =
        "write {type: table, angles: [0, 20, 40, 60], values: [1, 0.9, 0.4, 0]}";
    constexpr std::size_t k_max_angles = 1024;
    TableProfileDesc profile;
    const ConfigValue angles = map.require("angles", k_hint),
                      values = map.require("values", k_hint);
    for (const ConfigValue& entry : angles.list(k_hint)) {
        const double angle = entry.within(0, 180, "give angles from the lamp's axis in degrees");
        if (profile.angles.empty() ? angle != 0 : angle <= profile.angles.back())
            entry.fail(fmt::format("must ascend from 0, found {}; {}", angle, k_hint));
        profile.angles.push_back(angle);
    }
    if (profile.angles.size() < 2 || profile.angles.size() > k_max_angles)
        angles.fail(fmt::format("needs 2 to {} angles; {}", k_max_angles, k_hint));
    for (const ConfigValue& entry : values.list_of(profile.angles.size(), k_hint))
        profile.values.push_back(entry.within(
            0, 1, "give the intensity relative to the lamp's; divide by the greatest"));
    if (std::ranges::max(profile.values) == 0)
        values.fail("are all 0, so that the lamp is dark; give 1 where it is brightest");
    return profile;
}

double read_rotate(ConfigMap& map) {
    const auto rotate = map.find("rotate");
    return rotate ? rotate->within(-360, 360, "give the turn about the lamp's direction in degrees")
                  : 0;
}

LampProfileDesc read_ies_profile(ConfigMap& map, const SceneContext& context) {
    IesProfileDesc profile;
    profile.where = map.value().location();
    profile.file = read_existing_file(map.require("file", "name the IES file (LM-63)"), context);
    profile.rotate = read_rotate(map);
    if (const auto tilt = map.find("tilt"))
        profile.tilt = tilt->within(
            -180, 180, "give the angle between the lamp's direction and its axis in degrees");
    return profile;
}

LampProfileDesc read_line(ConfigMap& map, const SceneContext& /*context*/) {
    constexpr auto k_hint = "write {type: line, angle: 60, width: 0.2}, in degrees";
    constexpr double k_widest_fan = 170, k_widest = 20;
    LineProfileDesc profile;
    profile.angle = map.require("angle", k_hint).positive(k_hint);
    if (profile.angle > k_widest_fan)
        map.require("angle", k_hint)
            .fail(fmt::format("must be at most {:g}, found {:g}; give the full angle of the fan",
                              k_widest_fan, profile.angle));
    profile.width = map.require("width", k_hint).positive(k_hint);
    if (profile.width > k_widest)
        map.require("width", k_hint)
            .fail(fmt::format("must be at most {:g}, found {:g}; give the full angle across the "
                              "fan at half intensity",
                              k_widest, profile.width));
    profile.rotate = read_rotate(map);
    return profile;
}

LampProfileDesc read_image_profile(ConfigMap& map, const SceneContext& context) {
    constexpr auto k_hint = "give the full angle of the image's width in degrees";
    ImageProfileDesc profile;
    profile.where = map.value().location();
    profile.file = read_existing_file(map.require("file", "name the image"), context);
    profile.fov = map.require("fov", k_hint).between(0, 180, k_hint);
    profile.rotate = read_rotate(map);
    return profile;
}

LampProfileDesc read_profile(const ConfigValue& value, const SceneContext& context) {
    using Read = LampProfileDesc (*)(ConfigMap&, const SceneContext&);
    constexpr auto k_types =
        std::to_array<std::pair<std::string_view, Read>>({{"isotropic", read_isotropic},
                                                          {"spot", read_spot},
                                                          {"cosine", read_cosine},
                                                          {"table", read_table_profile},
                                                          {"ies", read_ies_profile},
                                                          {"line", read_line},
                                                          {"image", read_image_profile}});
    static_assert(k_types.size() == std::variant_size_v<LampProfileDesc>);
    constexpr auto k_example = "write {type: spot, beam: 60, edge: 5}";
    ConfigMap map(value,
                  {"type", "beam", "edge", "falloff", "fwhm", "angle", "width", "angles", "values",
                   "file", "fov", "rotate", "tilt"},
                  k_example);
    const ConfigValue type = map.require("type", k_example);
    LampProfileDesc profile = type.choice(k_types)(map, context);
    map.finish("profile type '" + type.node().scalar + "'");
    return profile;
}

/// Whether the profile determines the lamp's brightness.
bool is_absolute(const LampProfileDesc& profile) {
    return std::visit([](const auto& desc) { return desc.k_is_absolute; }, profile);
}

void read_lumens(const ConfigValue& value, std::string_view hint, LampDesc& lamp) {
    lamp.lumens = value.positive(hint);
    if (!lamp.spectrum) {
        value.fail(
            "only the lamp's spectrum can convert lumens to watts; give it, such as spectrum: "
            "{type: led, name: LED-B4}");
    }
}

/// A lamp with a spectrum has a single number, one without has a number per band. `unit`: "W/sr on
/// the axis".
PerBand read_watts(const ConfigValue& value, std::string_view unit, const SceneContext& context,
                   const LampDesc& lamp) {
    PerBand values = lamp.spectrum
                         ? PerBand{value.non_negative(fmt::format(
                               "with a spectrum, give its total {} as one number", unit))}
                         : value.non_negative_per_band(context.band_count,
                                                       fmt::format("give {}, per band", unit));
    if (std::all_of(values.begin(), values.end(), [](double x) { return x == 0; })) {
        context.warn(value, "is 0 in every band: this lamp is dark");
    }
    return values;
}

void read_output(ConfigMap& map, const SceneContext& context, LampDesc& lamp) {
    if (const auto entry = map.find("spectrum")) lamp.spectrum = read_spectrum(*entry, context);
    const auto intensity = map.find("intensity");
    const auto power = map.find("power");
    const auto lumens = map.find("lumens");
    if (intensity && power) {
        power->fail("a lamp has either intensity or power; remove one");
    }
    if (lumens && (intensity || power)) {
        lumens->fail("a lamp has either lumens or watts; remove one");
    }
    if (lumens) {
        read_lumens(*lumens, "give the luminous flux in lm", lamp);
    } else if (intensity) {
        lamp.intensity = read_watts(*intensity, "W/sr on the axis", context, lamp);
    } else if (power) {
        lamp.power = read_watts(*power, "W in all directions", context, lamp);
    } else if (!is_absolute(lamp.profile)) {
        map.value().fail(
            "does not say how bright it is; give intensity in W/sr or power in W, or its spectrum "
            "and lumens");
    }
}

void read_samples(ConfigMap& map, int& samples) {
    if (const auto entry = map.find("samples"))
        samples = entry->integer(1, 1024, "give the number of points that stand for it");
}

LampExtentDesc read_rectangle(ConfigMap& map) {
    LampExtentDesc extent;
    constexpr auto k_hint = "give the sides of the luminous rectangle in metres";
    extent.width = map.require("width", k_hint).positive(k_hint);
    extent.height = map.require("height", k_hint).positive(k_hint);
    if (const auto rotate = map.find("rotate"))
        extent.rotate =
            rotate->within(-360, 360, "give the turn about the lamp's direction in degrees");
    read_samples(map, extent.samples);
    return extent;
}

LampExtentDesc read_round(ConfigMap& map, LampExtentDesc::Shape shape, std::string_view hint) {
    LampExtentDesc extent;
    extent.shape = shape;
    extent.radius = map.require("radius", hint).positive(hint);
    read_samples(map, extent.samples);
    return extent;
}

enum class LampType { point, rectangle, disk, sphere, sun };

LampType read_type(ConfigMap& map) {
    constexpr auto k_types =
        std::to_array<std::pair<std::string_view, LampType>>({{"point", LampType::point},
                                                              {"rectangle", LampType::rectangle},
                                                              {"disk", LampType::disk},
                                                              {"sphere", LampType::sphere},
                                                              {"sun", LampType::sun}});
    const auto type = map.find("type");
    return type ? type->choice(k_types) : LampType::point;
}

void read_irradiance(ConfigMap& map, const SceneContext& context, LampDesc& lamp) {
    if (const auto entry = map.find("spectrum")) lamp.spectrum = read_spectrum(*entry, context);
    const auto irradiance = map.find("irradiance");
    const auto lux = map.find("lux");
    if (irradiance && lux) lux->fail("a sun has either lux or watts; remove one");
    if (irradiance)
        lamp.intensity = read_watts(*irradiance, "W/m2 at the water's surface", context, lamp);
    else if (lux)
        read_lumens(*lux, "give the illuminance in lx", lamp);
    else
        map.value().fail(
            "does not say how bright it is; give irradiance in W/m2, or its spectrum and lux");
}

/// A lamp of type sun. Its direction is the world's, in the water.
void read_sun(ConfigMap& map, const SceneContext& context, LampDesc& lamp) {
    SunDesc sun;
    constexpr auto k_hint = "give the direction in which its light travels in the water";
    lamp.direction = map.require("direction", k_hint).direction(k_hint);
    if (!context.water_surface)
        map.value().fail(
            "a sun's light begins at the water's surface, but the scene does not say where that "
            "is; give water: {surface: {point: [0, 10, 0], normal: [0, 1, 0]}}");
    sun.surface = *context.water_surface;
    if (const auto angle = map.find("angle"))
        sun.angle = angle->within(0, 90, "give the angle across the sun's disc in degrees");
    read_samples(map, sun.samples);
    lamp.sun = sun;
    lamp.fixed_to_camera = false;
    read_irradiance(map, context, lamp);
}

// What the lamp is fixed to.
void read_frame(ConfigMap& map, const SceneContext& context, LampDesc& lamp) {
    enum class Frame { camera, rig, world };
    constexpr std::array<std::pair<std::string_view, Frame>, 3> k_frames{
        {{"camera", Frame::camera}, {"rig", Frame::rig}, {"world", Frame::world}}};
    Frame frame = context.rig ? Frame::rig : Frame::camera;
    if (lamp.trajectory) frame = Frame::world;
    if (const auto entry = map.find("frame")) {
        frame = entry->choice(k_frames);
        if (frame == Frame::rig && !context.rig)
            entry->fail(
                "there is no rig in this scene; use camera or world, or give cameras: a list of "
                "named cameras");
        if (lamp.trajectory && frame != Frame::world)
            entry->fail("a lamp with a trajectory of its own is fixed to nothing else; remove one");
    }
    lamp.fixed_to_camera = frame == Frame::camera && !context.rig;
    if (context.rig && frame != Frame::world) {
        lamp.fixed_to_rig = true;
        lamp.world_from_mount =
            frame == Frame::rig ? context.rig->world_from_rig : context.rig->world_from_camera;
    }
}

/// A lamp that stands somewhere.
void read_placed(ConfigMap& map, LampType type, const SceneContext& context, LampDesc& lamp) {
    if (const auto entry = map.find("trajectory"))
        lamp.trajectory = read_trajectory(*entry, context, false);
    if (!lamp.trajectory || map.has("position"))
        lamp.position =
            at_origin_plus(map.require("position", "give the lamp's position in metres")
                               .vector("give the lamp's position, three lengths in metres"));
    if (const auto entry = map.find("direction"))
        lamp.direction = entry->direction("give the direction in which the lamp shines, not all 0");
    if (type == LampType::rectangle) lamp.extent = read_rectangle(map);
    if (type == LampType::disk)
        lamp.extent = read_round(map, LampExtentDesc::Shape::disk,
                                 "give the radius of the luminous disk in metres");
    // A diffuse surface, unless a profile says otherwise.
    if (lamp.extent) lamp.profile = CosineProfileDesc{120};
    if (type == LampType::sphere)
        lamp.extent = read_round(map, LampExtentDesc::Shape::sphere,
                                 "give the radius of the luminous sphere in metres");
    if (const auto entry = map.find("profile")) lamp.profile = read_profile(*entry, context);
    read_output(map, context, lamp);
    read_frame(map, context, lamp);
}

LampDesc read_lamp(const ConfigValue& value, std::size_t number, const SceneContext& context) {
    ConfigMap map(value,
                  {"name", "type", "position", "direction", "width", "height", "radius", "rotate",
                   "samples", "profile", "spectrum", "intensity", "power", "lumens", "frame",
                   "angle", "irradiance", "lux", "trajectory"},
                  "write {name: left, position: [-1, 0, 0], intensity: 50}");
    LampDesc lamp;
    lamp.where = value.location();
    const auto name = map.find("name");
    lamp.name = name ? read_short_name(*name, "a layer's name", "name the lamp, such as left")
                     : fmt::format("lamp{}", number);
    const LampType type = read_type(map);
    if (type == LampType::sun)
        read_sun(map, context, lamp);
    else
        read_placed(map, type, context, lamp);
    const ConfigNode* const word = value.node().find("type");
    map.finish(fmt::format("a lamp of type '{}'", word ? word->scalar : "point"));
    return lamp;
}

}  // namespace

std::vector<LampDesc> read_lamps(const ConfigValue& value, const SceneContext& context) {
    std::vector<LampDesc> lamps;
    for (const ConfigValue& entry : value.list("write one '- name: ...' per lamp")) {
        LampDesc lamp = read_lamp(entry, lamps.size() + 1, context);
        for (const LampDesc& other : lamps) {
            if (other.name == lamp.name) {
                entry.fail(fmt::format("the name '{}' is taken by another lamp; give each its own",
                                       lamp.name));
            }
        }
        lamps.push_back(std::move(lamp));
    }
    return lamps;
}

void append_emissions(const std::vector<VolumeDesc>& volumes, std::vector<LampDesc>& lamps) {
    for (std::size_t v = 0; v < volumes.size(); ++v)
        for (const EmissionDesc& emission : volumes[v].emission) {
            if (std::ranges::find(lamps, emission.name, &LampDesc::name) != lamps.end())
                throw InputError(fmt::format(
                    "{}: the name '{}' is taken by another lamp; give this light a name of its "
                    "own, such as {{per_unit: [4, 1.5, 0.3], name: fire}}",
                    emission.where, emission.name));
            LampDesc lamp;
            lamp.name = emission.name;
            lamp.emissive_volume = EmissiveVolumeDesc{v, emission};
            lamp.intensity = emission.per_unit;
            lamp.fixed_to_camera = false;
            lamp.where = emission.where;
            lamps.push_back(std::move(lamp));
        }
}

}  // namespace uw
