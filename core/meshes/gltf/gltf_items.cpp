#include "core/meshes/gltf/gltf_items.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <system_error>

#include "core/base/error.h"
#include "core/meshes/gltf/gltf_animation.h"
#include "core/meshes/gltf/gltf_inspection.h"
#include "core/meshes/gltf/gltf_nodes.h"

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

/// `extras` may hold anything: only numbers count.
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
    constexpr double k_most_shift = 10;  // Blender's own limit
    if (std::abs(camera.shift_x) > k_most_shift || std::abs(camera.shift_y) > k_most_shift) {
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
        throw InputError(
            fmt::format("{}: the glTF description is broken: {}", file.string(), error.what()));
    }
}

}  // namespace uw
