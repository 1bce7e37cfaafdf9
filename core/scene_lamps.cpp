#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/config_map.h"
#include "core/config_text.h"
#include "core/scene_sections.h"

namespace uw {
namespace {

constexpr std::size_t k_longest_name = 64;

/// Lamp names become parts of layer names.
std::string read_name(const ConfigValue& value) {
    constexpr std::string_view k_allowed =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    std::string name = value.text("name the lamp, such as left");
    if (name.find_first_not_of(k_allowed) != std::string::npos || name.size() > k_longest_name) {
        value.fail(
            fmt::format("'{}' cannot be part of a layer's name; use only letters, digits, _ "
                        "and -, at most {} of them",
                        printable(name), k_longest_name));
    }
    return name;
}

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

LampProfileDesc read_profile(const ConfigValue& value) {
    using Type = LampProfileDesc::Type;
    constexpr auto k_example = "write {type: spot, beam: 60, edge: 5}";
    ConfigMap map(value, {"type", "beam", "edge", "falloff", "fwhm", "file"}, k_example);
    const ConfigValue type = map.require("type", k_example);
    constexpr std::array<std::string_view, 4> k_types{"isotropic", "spot", "cosine", "ies"};
    LampProfileDesc profile;
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
            type.fail("'ies' is not supported yet; use isotropic, spot or cosine");
    }
    map.finish("profile type '" + type.node().scalar + "'");
    return profile;
}

void read_output(ConfigMap& map, const SceneContext& context, LampDesc& lamp) {
    const auto intensity = map.find("intensity");
    const auto power = map.find("power");
    if (intensity && power) {
        power->fail("a lamp has either intensity or power; remove one");
    }
    if (!intensity && !power) {
        map.value().fail("says not how bright it is; give intensity in W/sr or power in W");
    }
    const ConfigValue& given = intensity ? *intensity : *power;
    PerBand values = given.non_negative_per_band(
        context.band_count,
        intensity ? "give W/sr on the axis, per band" : "give the total in W, per band");
    if (std::all_of(values.begin(), values.end(), [](double x) { return x == 0; })) {
        context.warn(given, "is 0 in every band: this lamp is dark");
    }
    (intensity ? lamp.intensity : lamp.power) = std::move(values);
}

LampDesc read_lamp(const ConfigValue& value, std::size_t number, const SceneContext& context) {
    ConfigMap map(value,
                  {"name", "position", "direction", "profile", "intensity", "power", "frame"},
                  "write {name: left, position: [-1, 0, 0], intensity: 50}");
    LampDesc lamp;
    lamp.where = value.location();
    const auto name = map.find("name");
    lamp.name = name ? read_name(*name) : fmt::format("lamp{}", number);
    lamp.position =
        at_origin_plus(map.require("position", "give the lamp's position in metres")
                           .vector("give the lamp's position, three lengths in metres"));
    if (const auto entry = map.find("direction")) {
        lamp.direction = entry->direction("give the direction the lamp shines in, not all 0");
    }
    if (const auto entry = map.find("profile")) lamp.profile = read_profile(*entry);
    read_output(map, context, lamp);
    if (const auto entry = map.find("frame")) {
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_frames{
            {{"camera", true}, {"world", false}}};
        lamp.fixed_to_camera = entry->choice(k_frames);
    }
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

}  // namespace uw
