#include "core/geometry/gltf_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <numbers>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/gltf_inspection.h"
#include "core/geometry/gltf_nodes.h"
#include "core/geometry/mesh.h"

namespace uw {

namespace {

using Json = nlohmann::json;

constexpr auto k_lights = "KHR_lights_punctual";

std::string name_of(const Json& node, const Json& item, const char* kind, std::size_t number) {
    for (const Json* named : {&node, &item}) {
        std::string name = named->value("name", "");
        if (!name.empty()) return name;
    }
    return fmt::format("{}{}", kind, number);
}

GltfCamera read_camera(const GltfDocument& document, const Json& json) {
    GltfCamera camera;
    camera.perspective = json.value("type", "") == "perspective";
    if (!camera.perspective) return camera;
    const Json& lens = document.object(json, "perspective");
    camera.yfov = lens.value("yfov", 0.0);
    camera.aspect_ratio = lens.value("aspectRatio", 0.0);
    if (!(camera.yfov > 0 && camera.yfov < std::numbers::pi) || camera.aspect_ratio < 0) {
        document.fail("a glTF camera has an invalid yfov or aspectRatio");
    }
    return camera;
}

/// `extras` may contain anything: only numbers count.
double custom_number(const Json& extras, const char* key, double otherwise) {
    const auto found = extras.find(key);
    const bool is_number = found != extras.end() && found->is_number();
    return is_number ? found->get<double>() : otherwise;
}

void read_shift(const GltfDocument& document, const Json& owner, GltfCamera& camera) {
    const auto found = owner.find("extras");
    if (found == owner.end() || !found->is_object()) return;
    camera.shift_x = custom_number(*found, "shift_x", camera.shift_x);
    camera.shift_y = custom_number(*found, "shift_y", camera.shift_y);
    constexpr double k_max_shift = 10;  // Blender's own limit
    if (std::abs(camera.shift_x) > k_max_shift || std::abs(camera.shift_y) > k_max_shift) {
        document.fail("a glTF camera has a lens shift of more than 10 images");
    }
    const auto fit = found->find("sensor_fit");
    if (fit == found->end()) return;
    using Fit = GltfCamera::SensorFit;
    if (*fit == "AUTO") camera.sensor_fit = Fit::automatic;
    if (*fit == "HORIZONTAL") camera.sensor_fit = Fit::horizontal;
    if (*fit == "VERTICAL") camera.sensor_fit = Fit::vertical;
}

void read_cone(const GltfDocument& document, const Json& json, GltfLight& light) {
    const Json& spot = document.object(json, "spot");
    light.inner_cone = spot.value("innerConeAngle", 0.0);
    light.outer_cone = spot.value("outerConeAngle", std::numbers::pi / 4);
    // Stored as floats, so pi/2 may be slightly exceeded.
    constexpr double k_widest = std::numbers::pi / 2;
    if (light.outer_cone > k_widest && light.outer_cone < k_widest + 1e-6) {
        light.outer_cone = k_widest;
    }
    if (light.inner_cone > light.outer_cone && light.inner_cone < light.outer_cone + 1e-6) {
        light.inner_cone = light.outer_cone;
    }
    if (!(light.outer_cone > 0 && light.outer_cone <= k_widest && light.inner_cone >= 0 &&
          light.inner_cone <= light.outer_cone)) {
        document.fail("a glTF spot light has invalid cone angles");
    }
}

GltfLight read_light(const GltfDocument& document, const Json& json) {
    using Type = GltfLight::Type;
    GltfLight light;
    const std::string type = json.value("type", "");
    if (type == "spot") {
        light.type = Type::spot;
        read_cone(document, json, light);
    } else if (type == "directional") {
        light.type = Type::directional;
    } else if (type != "point") {
        document.fail("a glTF light is neither point, spot nor directional");
    }
    light.intensity = json.value("intensity", 1.0);
    light.color = json.value("color", std::array<double, 3>{1, 1, 1});
    light.has_range = json.contains("range");
    bool positive = light.intensity >= 0;
    for (const double c : light.color) positive = positive && c >= 0;
    if (!positive) document.fail("a glTF light has a negative intensity or colour");
    return light;
}

// Blender's exporter has the version of the Blender that it is part of: "Khronos glTF Blender I/O
// v3.4.50". The first ones, of 2.8, had numbers of their own, or none.
std::optional<BlenderVersion> blender_version(const GltfDocument& document) {
    const std::string generator =
        document.object(document.root(), "asset").value("generator", std::string());
    if (generator.find("Blender") == std::string::npos) return std::nullopt;
    BlenderVersion version{2, 8};
    const std::size_t v = generator.rfind(" v");
    if (v != std::string::npos) {
        const char* const end = generator.data() + generator.size();
        BlenderVersion read;
        const auto [point, fault] = std::from_chars(generator.data() + v + 2, end, read.first);
        if (fault == std::errc() && point != end && *point == '.' &&
            std::from_chars(point + 1, end, read.second).ec == std::errc())
            version = std::max(version, read);
    }
    return version;
}

GltfItems read_items(const GltfDocument& document, const GltfPoses& poses) {
    const Json& lights = document.list(document.extension(document.root(), k_lights), "lights");
    GltfItems items;
    items.written_by_blender = blender_version(document);
    for (const GltfNode& node : gltf_nodes(document, poses)) {
        if (node.json->contains("camera")) {
            const Json& json = document.element("cameras", *node.json, "camera");
            GltfCamera camera = read_camera(document, json);
            for (const Json* owner : {&json, node.json}) read_shift(document, *owner, camera);
            camera.name = name_of(*node.json, json, "camera", items.cameras.size() + 1);
            camera.file_from_camera = node.file_from_node;
            items.cameras.push_back(std::move(camera));
        }
        const Json& use = document.extension(*node.json, k_lights);
        if (use.empty()) continue;
        const std::uint64_t index = document.whole_number(use, "light", UINT64_MAX);
        if (index >= lights.size()) document.fail("glTF refers to a light that does not exist");
        GltfLight light = read_light(document, lights[index]);
        light.name = name_of(*node.json, lights[index], "light", items.lights.size() + 1);
        light.file_from_light = node.file_from_node;
        items.lights.push_back(std::move(light));
    }
    return items;
}

}  // namespace

GltfItems read_gltf_items(const std::filesystem::path& file, const std::optional<double>& time) {
    try {
        const GltfDocument document(file);
        if (!time) return read_items(document, {});
        inspect_gltf(document, {});  // the accessors
        GltfBytes bytes(document);
        return read_items(document, gltf_poses(document, bytes, *time));
    } catch (const Json::exception& error) {
        fail_broken_gltf(file, error);
    }
}

namespace {

constexpr double k_candela_per_watt = 683;  // per sr, as Blender converts
constexpr std::string_view k_give_surface =
    "say where the water's surface is, at which such light begins: water: {surface: {point: [0, "
    "10, "
    "0], normal: [0, 1, 0]}}";
constexpr std::size_t k_longest_name = 64;  // of a lamp, as in scene files

template <class Item>
std::string names_of(const std::vector<Item>& items) {
    std::string names;
    for (const Item& item : items) names += (names.empty() ? "" : ", ") + printable(item.name);
    return names;
}

/// The axis `v` of an object as a direction in the world.
Vector3 direction(const Affine& world_from_object, const Vector3& v, const SourceLocation& where) {
    const Vector3 mapped = world_from_object.apply_to_vector(v);
    const double length = glm::length(mapped);
    if (!(length > 0) || !std::isfinite(length)) {
        throw InputError(fmt::format("{}: its node or transform has a scale of 0", where));
    }
    return mapped / length;
}

Affine pose_of(const Affine& world_from_camera, const SourceLocation& where) {
    const Vector3 forward = direction(world_from_camera, {0, 0, -1}, where);
    const Vector3 up = direction(world_from_camera, {0, 1, 0}, where);
    const Vector3 side = glm::cross(forward, up);
    if (!(glm::length(side) > 1e-9)) {
        throw InputError(fmt::format("{}: its node or transform shears it flat", where));
    }
    const Vector3 right = glm::normalize(side);
    return {Matrix3(right, glm::cross(forward, right), forward), world_from_camera.offset()};
}

const GltfCamera& chosen_camera(const GltfItems& items, const GeometryDesc& object) {
    const SourceLocation& where = object.import.camera_where;
    const std::string& name = object.import.camera_name;
    const std::string file = printable(object.file.string(), 300);
    if (items.cameras.empty()) {
        throw InputError(
            fmt::format("{}: '{}' has no camera; export it with its cameras, or place "
                        "the camera in the scene",
                        where, file));
    }
    if (name.empty()) {
        if (items.cameras.size() == 1) return items.cameras.front();
        throw InputError(fmt::format("{}: '{}' has {} cameras; name one of {}", where, file,
                                     items.cameras.size(), names_of(items.cameras)));
    }
    const auto found = std::ranges::find(items.cameras, name, &GltfCamera::name);
    if (found != items.cameras.end()) return *found;
    throw InputError(fmt::format("{}: '{}' has no camera '{}'; it has {}", where, file,
                                 printable(name), names_of(items.cameras)));
}

/// The side of the image [pixels] in units of which a lens shift is given.
double shifted_side(GltfCamera::SensorFit fit, int width, int height) {
    switch (fit) {
        case GltfCamera::SensorFit::horizontal:
            return width;
        case GltfCamera::SensorFit::vertical:
            return height;
        case GltfCamera::SensorFit::automatic:
            break;
    }
    return std::max(width, height);
}

void import_camera(const GltfItems& items, const GeometryDesc& object, SceneDesc& scene) {
    const GltfCamera& source = chosen_camera(items, object);
    const SourceLocation& where = object.import.camera_where;
    if (!source.perspective) {
        throw InputError(fmt::format(
            "{}: the camera '{}' is orthographic, but underwater cameras are perspective; "
            "make it perspective",
            where, printable(source.name)));
    }
    CameraDesc& camera = scene.camera;
    if (!camera.has_pose) {
        camera.world_from_camera =
            pose_of(object.world_from_object * source.file_from_camera, where);
    }
    if (camera.has_intrinsics) return;
    const double focal = camera.height / 2.0 / std::tan(source.yfov / 2);
    // Blender moves the frame to the right and up, that is, the principal point to the left and
    // down in it.
    const double side = shifted_side(source.sensor_fit, camera.width, camera.height);
    camera.intrinsics = {focal, focal, camera.width / 2.0 - side * source.shift_x,
                         camera.height / 2.0 + side * source.shift_y};
    const double aspect = static_cast<double>(camera.width) / camera.height;
    if (source.aspect_ratio > 0 && std::abs(aspect / source.aspect_ratio - 1) > 0.01) {
        scene.warnings.push_back(
            fmt::format("{}: the camera '{}' was made for an aspect ratio of {:.3f}, but the image "
                        "has one of {:.3f}: it shows {} at the sides",
                        where, printable(source.name), source.aspect_ratio, aspect,
                        aspect > source.aspect_ratio ? "more" : "less"));
    }
}

std::string lamp_name(const std::string& source, const std::vector<LampDesc>& others) {
    const auto is_allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    };
    std::string base = source.substr(0, k_longest_name - 4);
    std::ranges::replace_if(base, std::not_fn(is_allowed), '_');
    std::string name = base;
    for (int number = 2; std::ranges::find(others, name, &LampDesc::name) != others.end();
         ++number) {
        name = fmt::format("{}_{}", base, number);
    }
    return name;
}

/// Radiant intensity on the axis [W/sr] of an intensity of 1.
double intensity_of_one(LightUnits units) {
    switch (units) {
        case LightUnits::standard:
            return 1 / k_candela_per_watt;
        case LightUnits::compat:
            return 1;
        case LightUnits::raw:
            break;
    }
    return 1 / (4 * std::numbers::pi);
}

/// As the program that wrote the file shades its spots.
SpotProfileDesc::Falloff falloff_of(const GltfItems& items) {
    using Falloff = SpotProfileDesc::Falloff;
    if (!items.written_by_blender) return Falloff::gltf;
    return *items.written_by_blender < BlenderVersion{3, 5} ? Falloff::blender_3_4
                                                            : Falloff::blender;
}

/// Irradiance [W/m^2] of a directional light of 1.
double irradiance_of_one(LightUnits units) {
    // Blender writes a sun's W/m^2 as they are, unless in lux.
    return units == LightUnits::standard ? 1 / k_candela_per_watt : 1;
}

LampDesc lamp_of(const GltfLight& source, const GeometryDesc& object, const SceneDesc& scene,
                 const ReflectanceBands& bands, SpotProfileDesc::Falloff falloff) {
    const Affine world_from_light = object.world_from_object * source.file_from_light;
    LampDesc lamp;
    lamp.where = object.import.lamps_where;
    lamp.fixed_to_camera = false;
    lamp.position = at_origin_plus(world_from_light.offset());
    lamp.direction = direction(world_from_light, {0, 0, -1}, lamp.where);
    if (source.type == GltfLight::Type::spot) {
        constexpr double k_degrees = 180 / std::numbers::pi;
        lamp.profile =
            SpotProfileDesc{(source.outer_cone + source.inner_cone) * k_degrees,
                            (source.outer_cone - source.inner_cone) * k_degrees, falloff};
    }
    const bool is_sun = source.type == GltfLight::Type::directional;
    if (is_sun) lamp.sun = SunDesc{.surface = scene.water.surface.value()};
    const Spectrum color = bands.from_rgb(source.color);
    const LightUnits units = object.import.units;
    const double watts =
        source.intensity * (is_sun ? irradiance_of_one(units) : intensity_of_one(units));
    lamp.intensity.emplace();
    for (std::size_t b = 0; b < static_cast<std::size_t>(bands.count()); ++b) {
        lamp.intensity->push_back(watts * color[b]);
    }
    return lamp;
}

/// The requested lights, each once, in the file's order; without suns if the water has no surface.
std::vector<const GltfLight*> chosen_lights(const GltfItems& items, const GeometryDesc& object,
                                            SceneDesc& scene) {
    const GltfImportDesc& import = object.import;
    for (const std::string& name : import.lamps) {
        const auto found = std::ranges::find(items.lights, name, &GltfLight::name);
        if (found == items.lights.end()) {
            throw InputError(fmt::format(
                "{}: '{}' has no light '{}'; {}", import.lamps_where,
                printable(object.file.string(), 300), printable(name),
                items.lights.empty() ? "it has none; export it with its lights (Blender leaves "
                                       "area lights out)"
                                     : "it has " + names_of(items.lights)));
        }
    }
    std::vector<const GltfLight*> chosen;
    std::string directional, ranged;
    for (const GltfLight& light : items.lights) {
        const bool is_named = std::ranges::find(import.lamps, light.name) != import.lamps.end();
        if (!import.all_lamps && !is_named) continue;
        const auto add_to = [&](std::string& list) {
            list += (list.empty() ? "" : ", ") + printable(light.name);
        };
        if (light.has_range) add_to(ranged);
        if (light.type != GltfLight::Type::directional || scene.water.surface) {
            chosen.push_back(&light);
        } else if (is_named) {
            throw InputError(fmt::format("{}: the light '{}' is directional (a sun); {}",
                                         import.lamps_where, printable(light.name),
                                         k_give_surface));
        } else {
            add_to(directional);
        }
    }
    const auto warn = [&](const std::string& names, std::string_view what, std::string_view hint) {
        if (!names.empty()) {
            scene.warnings.push_back(
                fmt::format("{}: {}: {}{}", import.lamps_where, what, names, hint));
        }
    };
    warn(directional, "directional lights (suns) are left out",
         fmt::format("; {}", k_give_surface));
    warn(ranged, "the range of lights is ignored; they go on falling off as 1/r^2", "");
    return chosen;
}

void import_lamps(const GltfItems& items, const GeometryDesc& object, SceneDesc& scene) {
    const ReflectanceBands bands(scene.water.bands_nm);
    const std::vector<const GltfLight*> lights = chosen_lights(items, object, scene);
    for (const GltfLight* light : lights) {
        LampDesc lamp = lamp_of(*light, object, scene, bands, falloff_of(items));
        lamp.name = lamp_name(light->name, scene.lamps);
        scene.lamps.push_back(std::move(lamp));
    }
    if (lights.empty()) {
        scene.warnings.push_back(
            fmt::format("{}: '{}' has no usable light; export it with its lights (Blender leaves "
                        "area lights out)",
                        object.import.lamps_where, printable(object.file.string(), 300)));
    }
}

/// In a scene without lamps, the lights that a key would make them.
void name_unused_lights(SceneDesc& scene) {
    for (const GeometryDesc& object : scene.geometry) {
        const std::string extension = object.file.extension().string();
        if (extension != ".gltf" && extension != ".glb") continue;
        if (object.import.any_lamps()) continue;
        const GltfItems items = read_gltf_items(object.file, object.time);
        if (items.lights.empty()) continue;
        scene.warnings.push_back(fmt::format(
            "{}: '{}' has lights that no key asks for: {}; take them with lamps: all", object.where,
            printable(object.file.string(), 300), names_of(items.lights)));
    }
}

}  // namespace

void import_gltf(SceneDesc& scene) {
    for (const GeometryDesc& object : scene.geometry) {
        if (!object.import.camera && !object.import.any_lamps()) continue;
        const GltfItems items = read_gltf_items(object.file, object.time);
        if (object.import.camera) import_camera(items, object, scene);
        if (object.import.any_lamps()) import_lamps(items, object, scene);
    }
    if (scene.lamps.empty()) name_unused_lights(scene);
}

}  // namespace uw
