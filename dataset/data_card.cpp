#include "dataset/data_card.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/text.h"
#include "core/light/integrator_table.h"
#include "core/light/medium.h"
#include "dataset/camera_json.h"
#include "dataset/formats.h"
#include "media/water/water_model.h"

namespace uw {

namespace {

Json water_json(const SceneDesc& scene) {
    const WaterModel water = build_water_model(scene.water, scene.volumes);
    Json a = Json::array(), b = Json::array(), c = Json::array(), phases = Json::array();
    for (int band = 0; band < water.medium.band_count(); ++band) {
        const double absorption = water.medium.uniform.absorption[static_cast<std::size_t>(band)];
        const double attenuation = water.medium.uniform.attenuation(band);
        a.push_back(absorption);
        b.push_back(attenuation - absorption);
        c.push_back(attenuation);
    }
    for (const auto& phase : water.medium.phase_functions) phases.push_back(phase->description());
    Json depths = Json::array(), at_depths = Json::array();
    for (const OpticalCoefficients& there : coefficients_by_depth(water)) {
        depths.push_back(water.strata->depths()[depths.size()]);
        const Spectrum attenuation = there.attenuation();
        at_depths.push_back(
            list_json(attenuation.first(static_cast<std::size_t>(water.medium.band_count()))));
    }
    return {
        {"preset", scene.water.preset},      {"bands_nm", scene.water.bands_nm},
        {"absorption_per_m", std::move(a)},  {"scattering_per_m", std::move(b)},
        {"attenuation_per_m", std::move(c)}, {"phase_functions", std::move(phases)},
        {"depths_m", std::move(depths)},     {"attenuation_at_depths_per_m", std::move(at_depths)},
        {"volumes", scene.volumes.size()}};
}

Json lamps_json(const SceneDesc& scene) {
    Json lamps = Json::array();
    for (const LampDesc& lamp : scene.lamps) {
        const char* const frame = lamp.sky               ? "sky"
                                  : lamp.sun             ? "sun"
                                  : lamp.emissive_volume ? "volume"
                                  : lamp.fixed_to_camera ? "camera"
                                  : lamp.fixed_to_rig    ? "rig"
                                                         : "world";
        lamps.push_back({{"name", lamp.name},
                         {"fixed_to", frame},
                         {"position", point_json(lamp.position)},
                         {"direction", vector_json(lamp.direction)}});
    }
    return lamps;
}

Json cameras_json(const SceneDesc& scene) {
    Json cameras = Json::array();
    const auto add = [&](const std::string& name, const CameraDesc& camera) {
        Json json = camera_json(camera);
        for (const char* key : {"position", "rotation_wxyz", "world_from_camera"}) json.erase(key);
        json["name"] = name;
        json["has_sensor"] = camera.sensor.has_value();
        cameras.push_back(std::move(json));
    };
    if (scene.cameras.empty()) add("", scene.camera);
    for (const RigCameraDesc& entry : scene.cameras) add(entry.name, entry.camera);
    return cameras;
}

std::string numbers(const Json& list) {
    std::string text;
    for (const Json& value : list)
        text += (text.empty() ? "" : ", ") + fmt::format("{:.5g}", value.get<double>());
    return text;
}

std::string camera_lines(const Json& camera) {
    const auto number = [&](const char* key) { return camera.at(key).get<double>(); };
    const std::string name = camera.at("name").get<std::string>();
    std::string text = fmt::format(
        "- {}{} × {} pixels, {}, fx {:.6g}, fy {:.6g}, cx {:.6g}, cy {:.6g} (the first pixel's "
        "centre "
        "is (0.5, 0.5))",
        name.empty() ? "" : "`" + name + "`: ", camera.at("width").get<int>(),
        camera.at("height").get<int>(), camera.at("model").get<std::string>(), number("fx"),
        number("fy"), number("cx"), number("cy"));
    text += "; k " + numbers(camera.at("k")) + "; p " + numbers(camera.at("p"));
    const Json& port = camera.at("port");
    if (!port.is_null()) {
        text += "; port: ";
        bool is_first = true;
        for (const auto& [key, value] : port.items()) {
            text += fmt::format("{}{} {}", is_first ? "" : ", ", key,
                                value.is_string() ? value.get<std::string>() : value.dump());
            is_first = false;
        }
    } else {
        text += "; no port";
    }
    return text + (camera.at("has_sensor").get<bool>() ? "; with a sensor\n" : "\n");
}

std::string lamp_lines(const Json& lamps) {
    std::string text;
    for (const Json& lamp : lamps)
        text +=
            fmt::format("- `{}`: fixed to the {}, position ({}), direction ({})\n",
                        lamp.at("name").get<std::string>(), lamp.at("fixed_to").get<std::string>(),
                        numbers(lamp.at("position")), numbers(lamp.at("direction")));
    return text.empty() ? "- none\n" : text;
}

std::string water_lines(const Json& water) {
    const std::string preset = water.at("preset").get<std::string>();
    std::string text = preset.empty() ? "" : fmt::format("Preset `{}`. ", preset);
    text +=
        "Uniform water, by band:\n\n| band [nm] | a [1/m] | b [1/m] | c [1/m] |\n"
        "| --- | --- | --- | --- |\n";
    for (std::size_t band = 0; band < water.at("bands_nm").size(); ++band) {
        const auto value = [&](const char* key) { return water.at(key).at(band).get<double>(); };
        text += fmt::format("| {:g} | {:.5g} | {:.5g} | {:.5g} |\n", value("bands_nm"),
                            value("absorption_per_m"), value("scattering_per_m"),
                            value("attenuation_per_m"));
    }
    for (const Json& phase : water.at("phase_functions"))
        text += fmt::format("\n- phase function: {}", phase.get<std::string>());
    if (const auto volumes = water.at("volumes").get<std::size_t>(); volumes > 0)
        text += fmt::format("\n- {} of particles besides", counted(volumes, "VDB volume"));
    return text + "\n";
}

}  // namespace

namespace {

/// The least and the most light left out of some views; null if they are rendered with all of it.
Json left_out_json(const SceneDesc& first, std::span<const LightLeftOut> left_out) {
    // The paper's image has no other light.
    if (left_out.empty() || first.render.output == RenderDesc::Output::paper) return nullptr;
    const auto [least, most] = std::ranges::minmax(left_out, {}, &LightLeftOut::fraction);
    return {{"least", least.fraction},
            {"most", most.fraction},
            {"views", left_out.size()},
            {"all_light", settings_of_all_light(first)}};
}

/// "12 % of their light" or "4 to 12 % ...", and how it is rendered.
std::string left_out_text(const Json& left_out) {
    const auto percent = [&](const char* key) {
        return fmt::format("{:.0f}", 100 * left_out.at(key).get<double>());
    };
    const std::string least = percent("least"), most = percent("most");
    const auto views = left_out.at("views").get<std::size_t>();
    return fmt::format(
        "single scattering leaves out about {} % of the light of {}, which is scattered or "
        "reflected more than once; {} renders it",
        least == most ? most : least + " to " + most,
        views == 1 ? std::string("the first view") : fmt::format("the {} views looked at", views),
        left_out.at("all_light").get<std::string>());
}

}  // namespace

std::string light_note(const DatasetFile& set) {
    const Json& left_out = set.facts.at("light_left_out");
    if (left_out.is_null() || !LightLeftOut{left_out.at("most").get<double>()}.matters()) return {};
    return left_out_text(left_out);
}

namespace {

Json sensors_json(const SceneDesc& first) {
    Json list = Json::array();
    for (const NavigationSensorDesc& sensor : first.navigation)
        list.push_back({{"name", sensor.name},
                        {"type", type_word(sensor)},
                        {"update_rate", sensor.update_rate}});
    return list;
}

/// The section on the vehicle's sensors; empty without any. `facts` are those of a set that an
/// earlier program may have begun.
std::string sensor_section(const DatasetDefinition& definition, const Json& facts) {
    if (!facts.contains("sensors") || facts.at("sensors").empty()) return {};
    std::string text = "\n## Sensors\n\n";
    bool all_are_imus = true;
    for (const Json& sensor : facts.at("sensors")) {
        const std::string type = sensor.at("type").get<std::string>();
        all_are_imus = all_are_imus && type == "imu";
        text += fmt::format("- `{}`: {}, {:g} readings a second\n",
                            sensor.at("name").get<std::string>(), type,
                            sensor.at("update_rate").get<double>());
    }
    if (definition.has_format("sensors")) return text;
    if (!definition.has_format("euroc"))
        return text + "\nTheir readings are not in this set, but in one with `--format sensors`.\n";
    return text + (all_are_imus
                       ? "\n`mav0/` has the readings, and not the truth of each, which a "
                         "set with `--format sensors` has.\n"
                       : "\n`mav0/` has those of IMUs alone; a set with `--format sensors` "
                         "has all, and the truth.\n");
}

}  // namespace

Json facts_of(const SceneDesc& first, std::span<const LightLeftOut> left_out) {
    Json geometry = Json::array();
    for (const GeometryDesc& entry : first.geometry)
        geometry.push_back(entry.type == GeometryDesc::Type::file ? entry.file.filename().string()
                                                                  : std::string("a shape"));
    return {{"cameras", cameras_json(first)},
            {"water", water_json(first)},
            {"lamps", lamps_json(first)},
            {"sensors", sensors_json(first)},
            {"geometry", std::move(geometry)},
            {"frames_per_second", first.render.fps},
            {"integrator", word_of(first.render.integrator, k_integrator_names)},
            {"scattering", word_of(scattering_of(first.render), k_scattering_names)},
            {"quality", word_of(first.render.quality, k_quality_names)},
            {"light_left_out", left_out_json(first, left_out)},
            {"samples", samples_of(first.render)}};
}

namespace {

/// How formats without ports represent a camera that has one; empty for one without. `fitted_in`
/// are those in which it is fitted; empty: none.
std::string pinhole_lines(const Json& camera, const std::optional<PinholeFit>& fit,
                          const std::string& fitted_in) {
    if (!fit) return {};
    std::string text = fmt::format(
        "  - seen through its port: surfaces {:.3g} to {:.3g} m away, {:.3g} m in the median. A "
        "camera without port, as this one is in air, is off by {}",
        fit->nearest, fit->farthest, fit->median, error_text(fit->in_air));
    if (fitted_in.empty())
        return text +
               fmt::format(
                   "; fitted, as `--pinhole-fit` does it for colmap, nerfstudio, euroc and mcap, "
                   "it would be off by {}\n",
                   error_text(fit->fitted));
    const IntrinsicsDesc& i = fit->intrinsics;
    return text + fmt::format(
                      "; fitted, as {} has it, by {}: {}, fx {:.6g}, fy {:.6g}, cx {:.6g}, cy "
                      "{:.6g}; k {}; p {}\n",
                      fitted_in, error_text(fit->fitted), camera.at("model").get<std::string>(),
                      i.fx, i.fy, i.cx, i.cy, numbers(fit->distortion.k),
                      numbers(fit->distortion.p));
}

}  // namespace

std::string data_card(const DatasetFile& set, const PinholeFits& fits, std::uint64_t bytes) {
    const DatasetDefinition& d = set.definition;
    std::string text = fmt::format("# Data set of {}\n\n", d.scene);
    text += fmt::format(
        "Rendered images of an underwater scene, with exact ground truth: {} ({} × {} × {}), "
        "{:.1f} MB. Nothing in it was photographed.\n\n",
        counted(d.view_count(), "view"), counted(d.draws.size(), "draw"),
        counted(d.frames.size(), "frame"), counted(d.cameras.size(), "camera"),
        static_cast<double>(bytes) / 1e6);
    text += fmt::format("- made by: {}\n- command: `{}`\n- scene: `{}`, hash `{}`\n", d.program,
                        d.command, d.scene, d.scene_hash);
    text += fmt::format("- licence: {}\n", d.licence.empty() ? "not stated" : d.licence);
    text += fmt::format(
        "- rendered with: integrator {}, {} scattering, quality {}, {} per pixel, {:g} frames per "
        "second\n",
        set.facts.at("integrator").get<std::string>(),
        set.facts.at("scattering").get<std::string>(), set.facts.at("quality").get<std::string>(),
        counted(set.facts.at("samples").get<std::size_t>(), "sample"),
        set.facts.at("frames_per_second").get<double>());
    if (const Json& left_out = set.facts.at("light_left_out"); !left_out.is_null())
        text += fmt::format("- light: {}\n", left_out_text(left_out));
    text +=
        fmt::format("- exposure of images without a sensor: R G B × {:.6g}", set.exposures.image);
    if (d.has_format("clean"))
        text += fmt::format("; of those without water × {:.6g}", set.exposures.clean);
    text += "\n";
    text += "\n## Cameras\n\n";
    const std::string fitted_in = d.pinhole_fit ? fittable_formats(d) : "";
    for (const Json& camera : set.facts.at("cameras")) {
        text += camera_lines(camera);
        const auto place = std::ranges::find(d.cameras, camera.at("name").get<std::string>());
        const auto index = static_cast<std::size_t>(place - d.cameras.begin());
        if (index < fits.size()) text += pinhole_lines(camera, fits[index], fitted_in);
    }
    if (!fits.empty() && d.draws.size() > 1)
        text +=
            "\nWhat is seen through ports is that of the first draw; `views/pinholes.json` has "
            "that "
            "of each.\n";
    text +=
        "\nPoses are of a camera with x right, y down, z forward; world and units (metres) are "
        "the scene's. `stamp_ns` of records and manifest are whole nanoseconds of the clock of the "
        "file that the poses come from, or else of the scene's time.\n\n## Water\n\n" +
        water_lines(set.facts.at("water"));
    text += "\n## Lamps\n\n" + lamp_lines(set.facts.at("lamps"));
    text += "\nPositions [m] and directions are in the axes of what a lamp is fixed to.\n" +
            sensor_section(d, set.facts) + "\n## Files\n\n";
    for (const std::string& name : d.formats)
        text += fmt::format("- {}\n", dataset_format(name).card);
    text +=
        "- `views/`: a JSON per view: pose, camera, time, its files and those that it was rendered "
        "from, with checksums.\n"
        "- `manifest.csv`, `manifest.json`: all views, their poses and files.\n"
        "- `SHA256SUMS`: `sha256sum -c SHA256SUMS` checks every file.\n"
        "- `index.html`: to look at; `contact_sheet.png`: the views at a glance.\n"
        "- `dataset.json`: what the set is; uwvdb continues it by that.\n";
    if (d.draws.size() > 1)
        text +=
            "\nEach draw has a folder of its own, `draw_00000` and so on, with all of the above "
            "but the last five.\n";
    text +=
        "\n## Limits\n\nGround truth is that of the scene, without error beyond rounding: depth, "
        "flow, masks and poses are of the pixel's centre through lens and port, never averaged. "
        "What the scene leaves out, the images do not show; uwvdb's documents say what the "
        "renderer leaves out.\n";
    return text;
}

}  // namespace uw
