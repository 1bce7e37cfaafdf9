#include "dataset/data_card.h"

#include <fmt/format.h>

#include "core/light/integrator_table.h"
#include "core/light/medium.h"
#include "dataset/camera_json.h"
#include "dataset/formats.h"
#include "media/water/water_model.h"

namespace uw {

namespace {

template <class T, std::size_t N>
std::string name_of(T value, const std::array<std::pair<std::string_view, T>, N>& names) {
    for (const auto& [name, known] : names)
        if (known == value) return std::string(name);
    return {};
}

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
    return {{"preset", scene.water.preset},      {"bands_nm", scene.water.bands_nm},
            {"absorption_per_m", std::move(a)},  {"scattering_per_m", std::move(b)},
            {"attenuation_per_m", std::move(c)}, {"phase_functions", std::move(phases)},
            {"volumes", scene.volumes.size()}};
}

Json lamps_json(const SceneDesc& scene) {
    Json lamps = Json::array();
    for (const LampDesc& lamp : scene.lamps) {
        const char* const frame = lamp.sun               ? "sun"
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

std::string counted(std::size_t number, std::string_view thing) {
    return fmt::format("{} {}{}", number, thing, number == 1 ? "" : "s");
}

Json facts_of(const SceneDesc& first) {
    Json geometry = Json::array();
    for (const GeometryDesc& entry : first.geometry)
        geometry.push_back(entry.type == GeometryDesc::Type::file ? entry.file.filename().string()
                                                                  : std::string("a shape"));
    return {{"cameras", cameras_json(first)},
            {"water", water_json(first)},
            {"lamps", lamps_json(first)},
            {"geometry", std::move(geometry)},
            {"frames_per_second", first.render.fps},
            {"integrator", name_of(first.render.integrator, k_integrator_names)},
            {"scattering", name_of(scattering_of(first.render), k_scattering_names)},
            {"quality", name_of(first.render.quality, k_quality_names)},
            {"samples", samples_of(first.render)}};
}

std::string data_card(const DatasetFile& set, std::uint64_t bytes) {
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
    text +=
        fmt::format("- exposure of images without a sensor: R G B × {:.6g}", set.exposures.image);
    if (d.has_format("clean"))
        text += fmt::format("; of those without water × {:.6g}", set.exposures.clean);
    text += "\n";
    text += "\n## Cameras\n\n";
    for (const Json& camera : set.facts.at("cameras")) text += camera_lines(camera);
    text +=
        "\nPoses are of a camera with x right, y down, z forward; world and units (metres) are "
        "the scene's.\n\n## Water\n\n" +
        water_lines(set.facts.at("water"));
    text += "\n## Lamps\n\n" + lamp_lines(set.facts.at("lamps"));
    text +=
        "\nPositions [m] and directions are in the axes of what a lamp is fixed to.\n\n## "
        "Files\n\n";
    for (const std::string& name : d.formats)
        text += fmt::format("- {}\n", dataset_format(name).card);
    text +=
        "- `views/`: a JSON per view: pose, camera, time, files and their checksums.\n"
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
