#include "core/scene/yaml/port_reader.h"

#include <fmt/format.h>

#include <array>

#include "core/scene/yaml/camera_values.h"
#include "core/scene/yaml/config_map.h"

namespace uw {
namespace {

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
