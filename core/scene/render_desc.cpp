#include "core/scene/render_desc.h"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "core/scene/config_value.h"
#include "core/scene/lamp_desc.h"
#include "core/scene/scene_context.h"

namespace uw {

namespace {

PlanesDesc read_planes(const ConfigValue& value) {
    ConfigMap map(value, {"count", "near", "far"}, "write {count: 64, near: 0.1, far: 12}");
    PlanesDesc planes;
    planes.where = value.location();
    if (const auto entry = map.find("count"))
        planes.count = entry->integer(1, 65536, "give the number of slabs");
    if (const auto entry = map.find("near")) planes.near = entry->non_negative("give metres");
    if (const auto entry = map.find("far")) {
        planes.far = entry->positive("give metres");
        if (planes.near && *planes.far <= *planes.near) {
            entry->fail(fmt::format("must be greater than near ({}); give metres along camera z",
                                    *planes.near));
        }
    }
    return planes;
}

/// `response` and `white` of `render`.
ColourDesc read_colour(ConfigMap& map, const SceneContext& context) {
    using Response = ColourDesc::Response;
    ColourDesc colour;
    colour.where = map.value().location() + ".response";
    if (const auto entry = map.find("response")) {
        colour.where = entry->location();
        const std::string text =
            entry->text("write cie, bands, or the name of a camera's CSV file");
        if (text.ends_with(".csv")) {
            colour.response = Response::camera;
            colour.file = read_existing_file(*entry, context);
        } else {
            constexpr std::array<std::pair<std::string_view, Response>, 3> k_responses{
                {{"auto", Response::automatic},
                 {"bands", Response::bands},
                 {"cie", Response::cie}}};
            colour.response = entry->choice(k_responses);
        }
        if (colour.response == Response::bands && context.band_count != 3)
            entry->fail("only three bands can be R, G and B themselves; write response: cie");
    }
    const auto white = map.find("white");
    if (!white) return colour;
    const bool bands_themselves =
        colour.response == Response::bands ||
        (colour.response == Response::automatic && context.band_count == 3);
    if (bands_themselves)
        white->fail("R, G and B are the three bands themselves; add response: cie");
    if (white->node().kind == ConfigNode::Kind::scalar) {
        constexpr std::array<std::pair<std::string_view, bool>, 1> k_words{{{"none", true}}};
        colour.raw = white->choice(k_words);
    } else {
        colour.white = read_spectrum(*white, context);
    }
    return colour;
}

ViewDesc read_view(const ConfigValue& value, const SceneContext& context) {
    ConfigMap map(value, {"config", "display", "view", "look", "input"},
                  "write {config: config.ocio, view: Filmic}");
    ViewDesc view;
    view.where = value.location();
    if (const auto entry = map.find("config")) view.config = read_existing_file(*entry, context);
    for (const auto& [key, word] : {std::pair{"display", &view.display},
                                    {"view", &view.view},
                                    {"look", &view.look},
                                    {"input", &view.input}})
        if (const auto entry = map.find(key)) *word = entry->text("give a name of the config's");
    return view;
}

/// `fps` and `times` of `render`.
void read_times(ConfigMap& map, RenderDesc& render) {
    if (const auto entry = map.find("fps")) {
        constexpr double k_min_fps = 1e-6, k_max_fps = 1e6;
        render.fps = entry->within(k_min_fps, k_max_fps, "give the frames per second, such as 25");
    }
    if (const auto entry = map.find("times")) {
        constexpr std::array<std::pair<std::string_view, RenderDesc::Times>, 2> k_times{
            {{"fps", RenderDesc::Times::fps}, {"trajectory", RenderDesc::Times::trajectory}}};
        render.times = entry->choice(k_times);
        render.times_where = entry->location();
    }
}

}  // namespace

RenderDesc read_render(const ConfigValue& value, const SceneContext& context) {
    ConfigMap map(value,
                  {"integrator", "scattering", "output", "planes", "samples", "shutter", "response",
                   "white", "view", "fps", "times"},
                  "write {samples: 4}");
    RenderDesc render;
    render.planes.where = value.location() + ".planes";
    if (const auto entry = map.find("integrator"))
        render.integrator = entry->choice(k_integrator_names);
    render.scattering_where = value.location() + ".scattering";
    if (const auto entry = map.find("scattering")) {
        render.scattering = entry->choice(k_scattering_names);
        render.scattering_where = entry->location();
    }
    if (const auto entry = map.find("output")) {
        constexpr std::array<std::pair<std::string_view, RenderDesc::Output>, 3> k_outputs{
            {{"radiance", RenderDesc::Output::radiance},
             {"sensor_irradiance", RenderDesc::Output::sensor_irradiance},
             {"paper", RenderDesc::Output::paper}}};
        render.output = entry->choice(k_outputs);
        render.output_where = entry->location();
    }
    if (const auto entry = map.find("planes")) render.planes = read_planes(*entry);
    if (const auto entry = map.find("samples")) {
        const bool paths = render.integrator == RenderDesc::Integrator::path;
        render.samples =
            entry->integer(1, paths ? k_max_paths : k_max_samples, "give the samples per pixel");
    }
    if (const auto entry = map.find("shutter")) {
        constexpr double k_longest = 60;
        render.shutter = entry->non_negative("give the exposure time in seconds, such as 0.02");
        if (render.shutter > k_longest)
            entry->fail("must not be more than a minute; give seconds, such as 0.02");
    }
    read_times(map, render);
    render.colour = read_colour(map, context);
    if (const auto entry = map.find("view")) render.view = read_view(*entry, context);
    return render;
}

}  // namespace uw
