#include "core/scene/scene_desc.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/scene/camera_desc.h"
#include "core/scene/config_value.h"
#include "core/scene/geometry_desc.h"
#include "core/scene/key_path.h"
#include "core/scene/lamp_desc.h"
#include "core/scene/render_desc.h"
#include "core/scene/scene_context.h"
#include "core/scene/sky_desc.h"
#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"
#include "core/scene/yaml_document.h"

namespace uw {

namespace {

constexpr int k_scene_version = 2;
constexpr const char* k_first_line = "a scene starts with 'uwvdb: 2'";

/// A scene file's name in messages.
std::string origin_of(const std::filesystem::path& file) {
    return printable(file.string(), 300);
}

/// The version of the scene's keys and defaults. Read first: another version may have other keys.
int read_version(const ConfigValue& scene) {
    const ConfigNode* const version = scene.node().find("uwvdb");
    if (version == nullptr) return k_scene_version;  // which is refused as missing
    double number = 0;
    if (version->kind == ConfigNode::Kind::scalar && !version->quoted &&
        parse_number(version->scalar, number) == NumberText::number &&
        (number == 1 || number == k_scene_version)) {
        return static_cast<int>(number);
    }
    ConfigValue(*version, "uwvdb")
        .fail(fmt::format("this program reads scene versions 1 and {0}, found {1}; write "
                          "'uwvdb: {0}', or use the program for that version",
                          k_scene_version, version->description()));
}

/// Checks that the scene lacks what a glTF file is to provide, and that a file provides what it
/// lacks.
void check_gltf_imports(const SceneDesc& desc) {
    const CameraDesc& camera = desc.camera;
    const SourceLocation* source = nullptr;
    for (const GeometryDesc& object : desc.geometry) {
        if (!object.import.camera) continue;
        const SourceLocation& where = object.import.camera_where;
        if (!desc.cameras.empty()) {
            throw InputError(
                fmt::format("{}: the scene has its own rig of cameras; remove this, or give camera "
                            "instead of cameras",
                            where));
        }
        if (source != nullptr) {
            throw InputError(
                fmt::format("{}: the camera is already taken from {}; remove one", where, *source));
        }
        if (camera.has_intrinsics && camera.has_pose) {
            throw InputError(
                fmt::format("{}: the scene's own camera has intrinsics and pose, which leaves "
                            "nothing to take from the file; remove one or both of them, or this",
                            where));
        }
        source = &where;
    }
    if (source != nullptr) return;
    const auto check = [](const CameraDesc& own) {
        if (own.has_intrinsics) return;
        throw InputError(fmt::format(
            "{}: 'intrinsics' is missing; give intrinsics: {{fov_x: 60}}, or fx, fy, cx, cy in "
            "pixels, or take a glTF file's with geometry: [{{file: x.glb, camera: true}}]",
            own.where));
    };
    check(camera);
    for (const RigCameraDesc& entry : desc.cameras) check(entry.camera);
}

void read_camera_or_rig(ConfigMap& map, SceneContext& context, SceneDesc& desc) {
    constexpr auto k_hint = "give camera: {resolution: [W, H], intrinsics: {fov_x: 60}}";
    const auto cameras = map.find("cameras");
    const auto rig = map.find("rig");
    if (!cameras) {
        if (rig) rig->fail("a rig has named cameras; list them under cameras, not camera");
        desc.camera = read_camera(map.require("camera", k_hint), context);
        return;
    }
    if (const auto camera = map.find("camera"))
        camera->fail("a scene has either camera or cameras; remove one");
    desc.cameras = read_cameras(*cameras, rig, context);
    desc.rig_trajectory = context.rig_trajectory;
    desc.camera = desc.cameras.front().camera;
    desc.camera_name = desc.cameras.front().name;
}

void check_lenses(const SceneDesc& desc) {
    if (desc.render.output == RenderDesc::Output::radiance) return;
    const bool all = desc.camera.lens && std::ranges::all_of(desc.cameras, [](const auto& entry) {
                         return entry.camera.lens.has_value();
                     });
    if (!all)
        throw InputError(desc.render.output_where +
                         ": needs the camera's lens; give camera.lens: {f_number: 2.8, "
                         "focal_length: 0.0085}, or write output: radiance");
}

/// The tolerated difference between a sensor's pitch and the lens, as data sheets round both.
constexpr double k_pitch_tolerance = 0.05;

void check_sensor(const SceneDesc& scene, const CameraDesc& camera) {
    const SensorDesc& sensor = *camera.sensor;
    const auto fail = [&](std::string_view what) {
        throw InputError(fmt::format("{}: {}", sensor.where, what));
    };
    if (!camera.lens)
        fail("needs the camera's lens; give camera.lens: {f_number: 2.8, focal_length: 0.0085}");
    if (scene.render.output != RenderDesc::Output::radiance)
        fail(
            "turns radiance into irradiance itself; write render.output: radiance, or leave it "
            "out");
    using Response = ColourDesc::Response;
    const Response response = scene.render.colour.response;
    if (scene.water.bands_nm.size() == 3 && response != Response::automatic &&
        response != Response::bands)
        fail(
            "needs the light per band, but R, G and B of the image are a colour here; leave out "
            "render.response, or use more than three bands");
    if (is_bayer(sensor.mosaic) && !camera.calibration && std::min(camera.width, camera.height) < 2)
        fail(
            "a Bayer mosaic has at least two rows and columns; give a larger resolution, or "
            "mosaic: mono");
    if (!sensor.exposure)
        fail(
            "'exposure' is missing; give the exposure time in seconds, such as 0.01, here or as "
            "render.shutter");
}

void warn_of_pitch(const CameraDesc& camera, std::vector<std::string>& warnings) {
    if (!camera.sensor->pixel_pitch || camera.calibration || !camera.has_intrinsics) return;
    const double focal_length = std::sqrt(camera.intrinsics.fx * camera.intrinsics.fy);
    const double of_lens = camera.lens->focal_length / focal_length;
    if (std::abs(of_lens / *camera.sensor->pixel_pitch - 1) <= k_pitch_tolerance) return;
    warnings.push_back(fmt::format(
        "{}: pixels of {:.3g} um do not fit a focal length of {:.4g} mm, {:.5g} pixels, which "
        "makes them {:.3g} um: the view is that of the intrinsics, the light that of these pixels",
        camera.sensor->where, 1e6 * *camera.sensor->pixel_pitch, 1e3 * camera.lens->focal_length,
        focal_length, 1e6 * of_lens));
}

/// Checks the sensors of all cameras against the rest of the scene, and gives those without an
/// exposure time that of render.shutter. Throws InputError; adds warnings.
void complete_sensors(SceneDesc& scene) {
    const auto complete = [&](CameraDesc& camera) {
        if (!camera.sensor) return;
        std::optional<double>& exposure = camera.sensor->exposure;
        if (!exposure && scene.render.shutter > 0) exposure = scene.render.shutter;
        check_sensor(scene, camera);
        warn_of_pitch(camera, scene.warnings);
    };
    for (RigCameraDesc& entry : scene.cameras) complete(entry.camera);
    if (scene.cameras.empty())
        complete(scene.camera);
    else
        scene.camera = scene.cameras.front().camera;
}

/// Gives the water before ports the scene's salinity and temperature where it has none of its own,
/// and all ports the indices of the wavelength that ground truth is of. Throws InputError for bands
/// at which their materials are not known.
void complete_ports(SceneDesc& scene) {
    const auto complete = [&](CameraDesc& camera) {
        if (!disperses(camera)) return;
        for (const double nm : scene.water.bands_nm)
            if (nm < k_shortest_dispersion_nm || nm > k_longest_dispersion_nm)
                throw InputError(fmt::format(
                    "{}: port: indices by material are known from {:g} to {:g} nm, and there is a "
                    "band at {:g} nm; give numbers for n_glass and n_water, or leave that band out",
                    camera.where, k_shortest_dispersion_nm, k_longest_dispersion_nm, nm));
        const auto complete_water = [&](std::optional<DispersionDesc>& material) {
            if (!material || material->material != DispersionDesc::Material::water) return;
            if (!material->salinity) material->salinity = scene.water.salinity;
            if (!material->temperature) material->temperature = scene.water.temperature;
        };
        std::visit(
            [&](auto& port) {
                complete_water(port.dispersion.air);
                complete_water(port.dispersion.glass);
                complete_water(port.dispersion.water);
            },
            *camera.port);
        set_wavelength(camera, reference_wavelength(scene.water.bands_nm));
    };
    complete(scene.camera);
    for (RigCameraDesc& entry : scene.cameras) complete(entry.camera);
}

/// Averaging blur takes more rays than antialiasing edges.
void refine_blur(SceneDesc& desc) {
    constexpr int k_samples = 64;
    const auto blurs = [](const CameraDesc& camera) {
        return camera.lens && camera.lens->focus_distance;
    };
    const bool any =
        blurs(desc.camera) || std::ranges::any_of(desc.cameras, blurs, &RigCameraDesc::camera);
    const bool traces_paths = desc.render.integrator == RenderDesc::Integrator::path;
    if (any && !desc.render.samples && !traces_paths) desc.render.samples = k_samples;
}

void check_times(const SceneDesc& desc) {
    if (desc.render.times == RenderDesc::Times::fps) return;
    if (!desc.camera.trajectory && !desc.rig_trajectory)
        throw InputError(desc.render.times_where +
                         ": needs camera.trajectory or rig.trajectory; add it, or remove this");
}

/// Sets the exposure time of the volumes that move.
void open_shutter(SceneDesc& desc) {
    for (VolumeDesc& volume : desc.volumes) {
        if (!volume.motion) continue;
        volume.motion->shutter = desc.render.shutter;
        const bool sets_off_light = std::ranges::any_of(
            volume.emission,
            [](const EmissionDesc& emission) { return emission.stimulus.has_value(); });
        if (desc.render.shutter == 0 && !sets_off_light)
            desc.warnings.push_back(volume.motion->where +
                                    ": has no effect without render.shutter, the exposure time");
    }
}

/// The tree of the scene itself, so that an image of a variation is that of the same scene without
/// the section.
ConfigNode without_variations(ConfigNode root) {
    std::erase_if(root.entries, [](const auto& entry) { return entry.key == k_variations_key; });
    return root;
}

}  // namespace

ConfigNode read_scene_tree(const std::filesystem::path& file,
                           const std::vector<std::string>& overrides) {
    return scene_tree(
        read_text_file(file, origin_of(file), YamlLimits{}.bytes, "scene", Pipes::read), file,
        overrides);
}

ConfigNode scene_tree(std::string_view text, const std::filesystem::path& file,
                      const std::vector<std::string>& overrides) {
    ConfigNode root = parse_yaml(text, origin_of(file));
    for (const std::string& change : overrides) apply_override(root, change);
    return root;
}

SceneDesc read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    return scene_of_tree(read_scene_tree(file, overrides), file);
}

SceneDesc read_scene_text(std::string_view text, const std::filesystem::path& file,
                          const std::vector<std::string>& overrides) {
    return scene_of_tree(scene_tree(text, file, overrides), file);
}

SceneDesc scene_of_tree(const ConfigNode& root, const std::filesystem::path& file,
                        const SceneArrays* arrays) {
    const ConfigValue scene(root, "");
    const int version = read_version(scene);
    ConfigMap map(scene,
                  {"uwvdb", "camera", "cameras", "rig", "water", "volumes", "geometry", "lamps",
                   "sky", "sensors", "render", k_variations_key},
                  k_first_line);
    map.require("uwvdb", k_first_line);

    SceneDesc desc;
    desc.file = file;
    SceneContext context{file.parent_path(), desc.water.bands_nm.size(), &desc.warnings};
    context.arrays = arrays;
    context.files = &desc.files;
    desc.water.where = scene.location();
    desc.render.planes.where = scene.location() + ": render.planes";
    desc.render.scattering_where = scene.location() + ": render.scattering";
    if (const auto entry = map.find("water")) desc.water = read_water(*entry, context);
    context.species = &desc.water.species;
    read_camera_or_rig(map, context, desc);
    if (const auto entry = map.find("volumes")) desc.volumes = read_volumes(*entry, context);
    if (const auto entry = map.find("geometry")) desc.geometry = read_geometry(*entry, context);
    if (const auto entry = map.find("lamps")) desc.lamps = read_lamps(*entry, context);
    if (const auto entry = map.find("sensors"))
        read_sensors(*entry, context, desc.meters, desc.navigation);
    append_emissions(desc.volumes, desc.lamps);
    if (const auto entry = map.find("sky")) append_sky(*entry, context, desc.lamps);
    if (const auto entry = map.find("render")) desc.render = read_render(*entry, context);
    desc.render.default_scattering =
        version == 1 ? RenderDesc::Scattering::single : RenderDesc::Scattering::multiple;
    open_shutter(desc);
    check_lenses(desc);
    complete_sensors(desc);
    complete_ports(desc);
    refine_blur(desc);
    check_times(desc);
    check_gltf_imports(desc);
    const bool brings_lamps = std::ranges::any_of(
        desc.geometry, [](const GeometryDesc& object) { return object.import.any_lamps(); });
    if (desc.lamps.empty() && !brings_lamps) {
        context.warn(
            scene,
            "there are no lamps, so all that does not emit light will be black; add 'lamps'");
    }
    desc.hash = config_hash(without_variations(root));
    return desc;
}

WaterDesc read_water_overrides(const std::vector<std::string>& overrides) {
    ConfigNode root = parse_yaml("water: {}", "water");
    for (const std::string& text : overrides) apply_override(root, text);
    return water_of_tree(root);
}

WaterDesc water_of_tree(const ConfigNode& root) {
    ConfigMap map(ConfigValue(root, ""), {"water"}, "without a scene only water can be set");
    std::vector<std::string> warnings;
    SceneContext context{{}, 0, &warnings};
    WaterDesc water = read_water(map.require("water", "give water.bands"), context);
    water.where = "water";  // no file to point into
    return water;
}

}  // namespace uw
