#include "core/scene/yaml/camera_values.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/scene/yaml/config_map.h"

namespace uw {
namespace {

constexpr int k_longest_side = 32768;
constexpr long long k_most_pixels = 1LL << 28;

double read_length(const ConfigValue& value, const SceneContext& context) {
    const double length = value.non_negative("give a length in metres");
    if (length > 1) {
        context.warn(value,
                     fmt::format("{} m is very large for a port; lengths are in metres", length));
    }
    return length;
}

/// The keys that flat and dome ports share.
template <class PortDescription>
void read_glass(ConfigMap& map, const SceneContext& context, PortDescription& port) {
    if (const auto entry = map.find("thickness")) port.thickness = read_length(*entry, context);
    if (const auto entry = map.find("n_air")) port.n_air = read_refractive_index(*entry);
    if (const auto entry = map.find("n_glass")) port.n_glass = read_refractive_index(*entry);
    if (const auto entry = map.find("n_water")) port.n_water = read_refractive_index(*entry);
    if (const auto fresnel = map.find("fresnel")) {
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_switch{
            {{"true", true}, {"false", false}}};
        port.fresnel = fresnel->choice(k_switch);
    }
    if (const auto medium = map.find("radiance_in")) {
        constexpr std::array<std::pair<std::string_view, bool>, 2> k_media{
            {{"water", false}, {"air", true}}};
        port.radiance_in_air = medium->choice(k_media);
    }
}

FlatPortDesc read_flat(ConfigMap& map, const SceneContext& context) {
    FlatPortDesc port;
    if (const auto normal = map.find("normal")) {
        port.normal =
            normal->direction("give the glass's normal in camera axes, towards the water");
        check_port_normal(*normal, port.normal);
    }
    if (const auto entry = map.find("distance")) port.distance = read_length(*entry, context);
    read_glass(map, context, port);
    map.finish("type 'flat'");
    return port;
}

DomePortDesc read_dome(ConfigMap& map, const SceneContext& context) {
    DomePortDesc port;
    if (const auto center = map.find("center"))
        port.center = at_origin_plus(center->vector("give the dome's centre in camera axes"));
    const ConfigValue radius =
        map.require("radius", "give the radius of the inner glass surface in metres");
    radius.positive("give the radius of the inner glass surface in metres");
    port.radius = read_length(radius, context);
    read_glass(map, context, port);
    map.finish("type 'dome'");
    check_dome(map.value(), port);
    return port;
}

}  // namespace

void read_resolution(const ConfigValue& both, const ConfigValue& width, const ConfigValue& height,
                     CameraDesc& camera) {
    constexpr auto k_mend = "give [width, height] in pixels";
    camera.width = width.integer(1, k_longest_side, k_mend);
    camera.height = height.integer(1, k_longest_side, k_mend);
    const long long pixels = static_cast<long long>(camera.width) * camera.height;
    if (pixels > k_most_pixels) {
        both.fail(fmt::format("{} x {} are more than {} pixels; give a smaller image", camera.width,
                              camera.height, k_most_pixels));
    }
}

double read_refractive_index(const ConfigValue& value) {
    return value.within(1, 3, "give a refractive index, such as 1.0, 1.49 or 1.334");
}

void check_port_normal(const ConfigValue& at, const Vector3& normal) {
    if (normal.z > 0) return;
    at.fail(
        "must point away from the camera (z > 0), found z <= 0; camera axes are x right, y down, "
        "z forward");
}

void check_dome(const ConfigValue& at, const DomePortDesc& dome) {
    const double offset = glm::length(from_origin(dome.center));
    if (offset < dome.radius) return;
    at.fail(
        fmt::format("the camera is outside its dome: it is {} m from the centre, but the inner "
                    "radius is {} m; give lengths in metres and the centre in camera axes",
                    offset, dome.radius));
}

PortDesc read_port(const ConfigValue& value, const SceneContext& context) {
    ConfigMap map(value,
                  {"type", "normal", "distance", "thickness", "n_air", "n_glass", "n_water",
                   "fresnel", "radiance_in", "center", "radius"},
                  "write {type: flat, distance: 0.02, thickness: 0.01}");
    enum class Type { flat, dome };
    constexpr std::array<std::pair<std::string_view, Type>, 2> k_types{
        {{"flat", Type::flat}, {"dome", Type::dome}}};
    Type type = Type::flat;
    if (const auto entry = map.find("type")) type = entry->choice(k_types);
    if (type == Type::dome) return read_dome(map, context);
    return read_flat(map, context);
}

}  // namespace uw
