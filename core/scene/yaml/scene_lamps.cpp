#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/text.h"
#include "core/scene/yaml/config_map.h"
#include "core/scene/yaml/scene_sections.h"

namespace uw {
namespace {

constexpr std::size_t k_longest_name = 64;

void read_spot(ConfigMap& map, LampProfileDesc& profile) {
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
        using Falloff = LampProfileDesc::Falloff;
        constexpr std::array<std::pair<std::string_view, Falloff>, 2> k_falloffs{
            {{"smooth", Falloff::smooth}, {"gltf", Falloff::gltf}}};
        profile.falloff = falloff->choice(k_falloffs);
    }
}

void read_ies_profile(ConfigMap& map, const SceneContext& context, LampProfileDesc& profile) {
    profile.file = read_existing_file(map.require("file", "name the IES file (LM-63)"), context);
    if (const auto rotate = map.find("rotate"))
        profile.rotate =
            rotate->within(-360, 360, "give the turn about the lamp's direction in degrees");
    if (const auto tilt = map.find("tilt"))
        profile.tilt = tilt->within(
            -180, 180, "give the angle between the lamp's direction and its axis in degrees");
}

LampProfileDesc read_profile(const ConfigValue& value, const SceneContext& context) {
    using Type = LampProfileDesc::Type;
    constexpr auto k_example = "write {type: spot, beam: 60, edge: 5}";
    ConfigMap map(value, {"type", "beam", "edge", "falloff", "fwhm", "file", "rotate", "tilt"},
                  k_example);
    const ConfigValue type = map.require("type", k_example);
    constexpr std::array<std::string_view, 4> k_types{"isotropic", "spot", "cosine", "ies"};
    LampProfileDesc profile;
    profile.where = value.location();
    switch (type.word_index(k_types)) {
        case 0:
            profile.type = Type::isotropic;
            break;
        case 1:
            profile.type = Type::spot;
            read_spot(map, profile);
            break;
        case 2: {
            profile.type = Type::cosine;
            constexpr auto k_mend = "give the full angle at half intensity in degrees";
            profile.fwhm = map.require("fwhm", k_mend).between(0, 180, k_mend);
            break;
        }
        default:
            profile.type = Type::ies;
            read_ies_profile(map, context, profile);
    }
    map.finish("profile type '" + type.node().scalar + "'");
    return profile;
}

void read_lumens(const ConfigValue& value, LampDesc& lamp) {
    lamp.lumens = value.positive("give the luminous flux in lm");
    if (!lamp.spectrum) {
        value.fail(
            "lumens become watts by the lamp's spectrum only; give it, such as spectrum: {type: "
            "led, name: LED-B4}");
    }
}

/// A lamp with a spectrum has one number for all of it, one without a number per band.
void read_watts(const ConfigValue& value, bool is_intensity, const SceneContext& context,
                LampDesc& lamp) {
    PerBand values;
    if (lamp.spectrum) {
        values = {value.non_negative(is_intensity
                                         ? "with a spectrum give the W/sr of all of it, one number"
                                         : "with a spectrum give the W of all of it, one number")};
    } else {
        values = value.non_negative_per_band(
            context.band_count,
            is_intensity ? "give W/sr on the axis, per band" : "give the total in W, per band");
    }
    if (std::all_of(values.begin(), values.end(), [](double x) { return x == 0; })) {
        context.warn(value, "is 0 in every band: this lamp is dark");
    }
    (is_intensity ? lamp.intensity : lamp.power) = std::move(values);
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
        read_lumens(*lumens, lamp);
    } else if (intensity || power) {
        read_watts(intensity ? *intensity : *power, intensity.has_value(), context, lamp);
    } else if (lamp.profile.type != LampProfileDesc::Type::ies) {
        map.value().fail(
            "says not how bright it is; give intensity in W/sr or power in W, or its spectrum and "
            "lumens");
    }
}

LampDesc read_lamp(const ConfigValue& value, std::size_t number, const SceneContext& context) {
    ConfigMap map(value,
                  {"name", "position", "direction", "profile", "spectrum", "intensity", "power",
                   "lumens", "frame"},
                  "write {name: left, position: [-1, 0, 0], intensity: 50}");
    LampDesc lamp;
    lamp.where = value.location();
    const auto name = map.find("name");
    lamp.name = name ? read_short_name(*name, "a layer's name", "name the lamp, such as left")
                     : fmt::format("lamp{}", number);
    lamp.position =
        at_origin_plus(map.require("position", "give the lamp's position in metres")
                           .vector("give the lamp's position, three lengths in metres"));
    if (const auto entry = map.find("direction")) {
        lamp.direction = entry->direction("give the direction the lamp shines in, not all 0");
    }
    if (const auto entry = map.find("profile")) lamp.profile = read_profile(*entry, context);
    read_output(map, context, lamp);
    enum class Frame { camera, rig, world };
    constexpr std::array<std::pair<std::string_view, Frame>, 3> k_frames{
        {{"camera", Frame::camera}, {"rig", Frame::rig}, {"world", Frame::world}}};
    Frame frame = context.rig ? Frame::rig : Frame::camera;
    if (const auto entry = map.find("frame")) {
        frame = entry->choice(k_frames);
        if (frame == Frame::rig && !context.rig) {
            entry->fail(
                "there is no rig in this scene; use camera or world, or give cameras: a list of "
                "named cameras");
        }
    }
    lamp.fixed_to_camera = frame == Frame::camera && !context.rig;
    if (context.rig && frame != Frame::world) {
        lamp.world_from_mount =
            frame == Frame::rig ? context.rig->world_from_rig : context.rig->world_from_camera;
    }
    return lamp;
}

}  // namespace

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
        constexpr auto k_mend = "give the colour temperature in kelvin, such as 5600";
        spectrum.temperature = map.require("temperature", k_mend).within(500, 100000, k_mend);
    }
    if (spectrum.type == Type::led) {
        constexpr auto k_mend = "name one of the CIE's LED illuminants, such as LED-B4";
        spectrum.name = map.require("name", k_mend).text(k_mend);
    }
    map.finish("spectrum type '" + type.node().scalar + "'");
    return spectrum;
}

std::string read_short_name(const ConfigValue& value, std::string_view of, std::string_view mend) {
    constexpr std::string_view k_allowed =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    std::string name = value.text(mend);
    if (name.find_first_not_of(k_allowed) != std::string::npos || name.size() > k_longest_name) {
        value.fail(
            fmt::format("'{}' cannot be part of {}; use only letters, digits, _ and -, at "
                        "most {} of them",
                        printable(name), of, k_longest_name));
    }
    return name;
}

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

}  // namespace uw
