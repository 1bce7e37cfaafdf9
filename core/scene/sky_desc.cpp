#include "core/scene/sky_desc.h"

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

namespace uw {

SunPositionDesc read_sun_position(const ConfigValue& value, const SceneContext& /*context*/) {
    constexpr auto k_example = "write {azimuth: 180, elevation: 40} or {direction: [0.3, -1, 0]}";
    ConfigMap map(value, {"azimuth", "elevation", "direction"}, k_example);
    if (const auto direction = map.find("direction")) {
        map.finish("a sun with 'direction'");
        return SunDirectionDesc{
            direction->direction("give the direction in which its light travels in the air")};
    }
    SunAnglesDesc angles;
    angles.elevation =
        map.require("elevation", k_example)
            .within(0, 90, "give the sun's angle above the horizon in degrees, 0 to 90");
    angles.azimuth =
        map.require("azimuth", k_example)
            .within(-360, 360, "give the sun's angle from north, clockwise from above, in degrees");
    return angles;
}

namespace {

using SkyModel = SkyDesc::Model;

// As much as no clear sky's model says by itself.
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
    } else if (sky.model != SkyModel::clear) {
        map.value().fail(
            "does not say how bright it is; give irradiance in W/m2 of a horizontal surface in "
            "the air, or its spectrum and lux");
    } else if (sky.spectrum) {
        map.value().fail(
            "a clear sky has a spectrum of its own; give irradiance or lux with this one, or "
            "remove it");
    }
    if (sky.irradiance &&
        std::ranges::all_of(*sky.irradiance, [](double value) { return value == 0; }))
        context.warn(*irradiance, "is 0 in every band: this sky is dark; model: black is the same");
}

void read_clear(ConfigMap& map, const SceneContext& context, SkyDesc& sky) {
    constexpr auto k_mend = "say where the sun stands, such as {azimuth: 180, elevation: 40}";
    sky.sun = read_sun_position(map.require("sun", k_mend), context);
    if (const auto turbidity = map.find("turbidity"))
        sky.turbidity = turbidity->within(
            2, 10, "give the air's turbidity: 2 is very clear, 3 clear, 6 hazy, 10 foggy");
    if (const auto north = map.find("north"))
        sky.north = north->direction("give the world's direction to the north, not all 0");
}

}  // namespace

SkyDesc read_sky(const ConfigValue& value, const SceneContext& context) {
    constexpr auto k_example = "write {model: overcast, lux: 10000, spectrum: {type: d65}}";
    ConfigMap map(
        value, {"model", "irradiance", "lux", "spectrum", "turbidity", "sun", "north", "samples"},
        k_example);
    SkyDesc sky;
    sky.where = value.location();
    constexpr auto k_models =
        std::to_array<std::pair<std::string_view, SkyModel>>({{"uniform", SkyModel::uniform},
                                                              {"black", SkyModel::black},
                                                              {"overcast", SkyModel::overcast},
                                                              {"clear", SkyModel::clear}});
    const ConfigValue model = map.require("model", k_example);
    sky.model = model.choice(k_models);
    if (sky.model == SkyModel::clear) read_clear(map, context, sky);
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
    if (!context.water_surface || !context.water_surface->n)
        value.fail(
            "its light is refracted by the water's surface; add water: {surface: {height: 10, n: "
            "1.34}}");
    if (std::ranges::find(lamps, "sky", &LampDesc::name) != lamps.end())
        value.fail("its light is called 'sky', but so is a lamp; give the lamp another name");
    LampDesc lamp;
    lamp.name = "sky";
    lamp.sky = std::make_shared<const SkyDesc>(read_sky(value, context));
    lamp.direction = -context.water_surface->normal;
    lamp.sun = SunDesc{.surface = *context.water_surface};
    lamp.intensity = PerBand(context.band_count, 0.0);
    lamp.fixed_to_camera = false;
    lamp.where = value.location();
    lamps.push_back(std::move(lamp));
}

}  // namespace uw
