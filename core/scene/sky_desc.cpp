#include "core/scene/sky_desc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>

#include "core/base/text.h"

namespace uw {

namespace {

/// The number that the next `digits` characters of `text` are, which are taken from it; none if
/// they are something else.
std::optional<int> take_digits(std::string_view& text, std::size_t digits) {
    int number = 0;
    if (text.size() < digits) return std::nullopt;
    for (std::size_t i = 0; i < digits; ++i) {
        if (!is_digit(text[i])) return std::nullopt;
        number = 10 * number + (text[i] - '0');
    }
    text.remove_prefix(digits);
    return number;
}

/// Hours and minutes, "12:30" [s].
std::optional<int> take_hours(std::string_view& text) {
    const std::optional<int> hours = take_digits(text, 2);
    if (!hours || *hours > 23 || !take_beginning(text, ":")) return std::nullopt;
    const std::optional<int> minutes = take_digits(text, 2);
    if (!minutes || *minutes > 59) return std::nullopt;
    return 3600 * *hours + 60 * *minutes;
}

/// A time with its zone, as ISO 8601 has it: "2024-06-21T12:30:00Z", "2024-06-21 14:30+02:00".
std::optional<double> unix_time(std::string_view text) {
    const std::optional<int> year = take_digits(text, 4);
    if (!year || !take_beginning(text, "-")) return std::nullopt;
    const std::optional<int> month = take_digits(text, 2);
    if (!month || !take_beginning(text, "-")) return std::nullopt;
    const std::optional<int> day = take_digits(text, 2);
    if (!day || !(take_beginning(text, "T") || take_beginning(text, " "))) return std::nullopt;
    const std::chrono::year_month_day date{std::chrono::year(*year),
                                           std::chrono::month(static_cast<unsigned>(*month)),
                                           std::chrono::day(static_cast<unsigned>(*day))};
    const std::optional<int> hours = take_hours(text);
    if (!date.ok() || !hours) return std::nullopt;
    double seconds = 0;
    if (take_beginning(text, ":")) {
        const std::optional<int> whole = take_digits(text, 2);
        if (!whole || *whole > 59) return std::nullopt;
        seconds = *whole;
        if (take_beginning(text, "."))
            for (double unit = 0.1; !text.empty() && is_digit(text.front()); unit /= 10)
                seconds += unit * *take_digits(text, 1);
    }
    int zone = 0;
    const bool is_east = take_beginning(text, "+");
    if (is_east || take_beginning(text, "-")) {
        const std::optional<int> offset = take_hours(text);
        if (!offset) return std::nullopt;
        zone = is_east ? *offset : -*offset;
    } else if (!take_beginning(text, "Z")) {
        return std::nullopt;
    }
    if (!text.empty()) return std::nullopt;
    const std::chrono::sys_days days(date);
    return 86400.0 * static_cast<double>(days.time_since_epoch().count()) + *hours + seconds - zone;
}

SunTimeDesc read_sun_time(ConfigMap& map) {
    constexpr auto k_example =
        "write {time: 2024-06-21T12:30:00Z, latitude: 54.3, longitude: 10.1}";
    const ConfigValue time = map.require("time", k_example);
    const std::optional<double> moment = unix_time(time.text(k_example));
    if (!moment)
        time.fail(fmt::format(
            "no time '{}'; give date, time and zone, such as 2024-06-21T12:30:00Z (UTC) or "
            "2024-06-21T14:30:00+02:00",
            printable(time.node().scalar)));
    SunTimeDesc sun;
    sun.unix_time = *moment;
    // Meeus' formulas hold for some centuries around 2000.
    constexpr double k_year_1900 = -2208988800, k_year_2101 = 4133980800;
    if (sun.unix_time < k_year_1900 || sun.unix_time >= k_year_2101)
        time.fail("is not from 1900 to 2100, for which the sun's position is known; give another");
    sun.latitude = map.require("latitude", k_example)
                       .within(-90, 90, "give the latitude in degrees, northward");
    sun.longitude = map.require("longitude", k_example)
                        .within(-180, 180, "give the longitude in degrees, eastward");
    return sun;
}

}  // namespace

SunPositionDesc read_sun_position(const ConfigValue& value, const SceneContext& /*context*/) {
    constexpr auto k_example =
        "write {azimuth: 180, elevation: 40}, {direction: [0.3, -1, 0]} or {time: "
        "2024-06-21T12:30:00Z, latitude: 54.3, longitude: 10.1}";
    ConfigMap map(value, {"azimuth", "elevation", "direction", "time", "latitude", "longitude"},
                  k_example);
    if (const auto direction = map.find("direction")) {
        map.finish("a sun with 'direction'");
        return SunDirectionDesc{
            direction->direction("give the direction in which its light travels in the air")};
    }
    if (map.has("time")) {
        const SunTimeDesc sun = read_sun_time(map);
        map.finish("a sun with 'time'");
        return sun;
    }
    SunAnglesDesc angles;
    angles.elevation =
        map.require("elevation", k_example)
            .within(0, 90, "give the sun's angle above the horizon in degrees, 0 to 90");
    angles.azimuth =
        map.require("azimuth", k_example)
            .within(-360, 360, "give the sun's angle from north, clockwise from above, in degrees");
    map.finish("a sun with 'elevation'");
    return angles;
}

namespace {

using SkyModel = SkyDesc::Model;

/// Whether an image or a model says by itself how bright it is.
bool has_own_brightness(SkyModel model) {
    return model == SkyModel::clear || model == SkyModel::panorama;
}

void read_brightness(ConfigMap& map, const SceneContext& context, SkyDesc& sky) {
    if (const auto entry = map.find("spectrum")) sky.spectrum = read_spectrum(*entry, context);
    const auto irradiance = map.find("irradiance"), lux = map.find("lux");
    if (irradiance && lux) lux->fail("a sky has either lux or watts; remove one");
    if (irradiance && sky.spectrum) {
        sky.irradiance = {irradiance->non_negative(
            "with a spectrum, give the total W/m2 of a horizontal surface as one number")};
    } else if (irradiance) {
        sky.irradiance = irradiance->non_negative_per_band(
            context.band_count, "give W/m2 of a horizontal surface in the air, per band");
    } else if (lux) {
        sky.lux = lux->positive("give the illuminance of a horizontal surface in the air in lx");
        if (!sky.spectrum && sky.model != SkyModel::clear)
            lux->fail(
                "only the sky's spectrum can convert lux to watts; give it, such as spectrum: "
                "{type: d65}");
    } else if (!has_own_brightness(sky.model)) {
        map.value().fail(
            "does not say how bright it is; give irradiance in W/m2 of a horizontal surface in "
            "the air, or its spectrum and lux");
    } else if (sky.spectrum) {
        map.value().fail(
            "this sky has a spectrum of its own; give irradiance or lux with another one, or "
            "remove "
            "it");
    }
    if (sky.irradiance &&
        std::ranges::all_of(*sky.irradiance, [](double value) { return value == 0; }))
        context.warn(*irradiance, "is 0 in every band: this sky is dark; model: black is the same");
}

void read_north(ConfigMap& map, SkyDesc& sky) {
    if (const auto north = map.find("north"))
        sky.north = north->direction("give the world's direction to the north, not all 0");
}

void read_clear(ConfigMap& map, const SceneContext& context, SkyDesc& sky) {
    constexpr auto k_hint = "say where the sun stands, such as {azimuth: 180, elevation: 40}";
    sky.sun = read_sun_position(map.require("sun", k_hint), context);
    if (const auto turbidity = map.find("turbidity"))
        sky.turbidity = turbidity->within(
            2, 10, "give the air's turbidity: 2 is very clear, 3 clear, 6 hazy, 10 foggy");
    read_north(map, sky);
}

void read_panorama(ConfigMap& map, const SceneContext& context, SkyDesc& sky) {
    sky.file = read_existing_file(
        map.require("file", "name a panorama in OpenEXR, TIFF or Radiance HDR"), context);
    if (const auto rotate = map.find("rotate"))
        sky.rotate = rotate->within(
            -360, 360, "give the panorama's turn in degrees, clockwise from above, from north");
    read_north(map, sky);
}

}  // namespace

SkyDesc read_sky(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_example = "write {model: overcast, lux: 10000, spectrum: {type: d65}}";
    ConfigMap map(value,
                  {"model", "irradiance", "lux", "spectrum", "turbidity", "sun", "file", "rotate",
                   "north", "samples"},
                  k_example);
    SkyDesc sky;
    sky.where = value.location();
    constexpr auto k_models =
        std::to_array<std::pair<std::string_view, SkyModel>>({{"uniform", SkyModel::uniform},
                                                              {"black", SkyModel::black},
                                                              {"overcast", SkyModel::overcast},
                                                              {"clear", SkyModel::clear},
                                                              {"panorama", SkyModel::panorama}});
    const ConfigValue model = map.require("model", k_example);
    sky.model = model.choice(k_models);
    if (sky.model == SkyModel::clear) read_clear(map, context, sky);
    if (sky.model == SkyModel::panorama) read_panorama(map, context, sky);
    if (sky.model != SkyModel::black) {
        read_brightness(map, context, sky);
        if (const auto samples = map.find("samples"))
            sky.samples = samples->integer(1, 1024, "give the number of directions of its light");
    }
    map.finish("sky model '" + model.node().scalar + "'");
    return sky;
}

void append_sky(const ConfigValue& value, const SceneContext& context,
                std::vector<LampDesc>& lamps) {
    LampDesc lamp;
    lamp.name = "sky";
    lamp.sky = std::make_shared<const SkyDesc>(read_sky(value, context));
    if (!context.water_surface || !context.water_surface->n)
        value.fail(
            "its light is refracted by the water's surface; add water: {surface: {height: 10, n: "
            "1.34}}");
    if (std::ranges::find(lamps, "sky", &LampDesc::name) != lamps.end())
        value.fail("its light is called 'sky', but so is a lamp; give the lamp another name");
    lamp.direction = -context.water_surface->normal;
    lamp.sun = SunDesc{.surface = *context.water_surface};
    lamp.intensity = PerBand(context.band_count, 0.0);
    lamp.fixed_to_camera = false;
    lamp.where = value.location();
    lamps.push_back(std::move(lamp));
}

}  // namespace uw
