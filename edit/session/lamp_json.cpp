#include "edit/session/lamp_json.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>
#include <utility>
#include <variant>

#include "edit/session/config_json.h"
#include "edit/session/view_geometry.h"

namespace uw {

namespace {

Json pixel_json(const ImagePoint& pixel) {
    return Json::array({number_json(pixel.x), number_json(pixel.y)});
}

Json handle_json(const Camera& camera, const Point3& world) {
    const ViewHandle handle = view_handle(camera, world);
    return {{"point", point_json(world)},
            {"pixel", handle.pixel ? pixel_json(*handle.pixel) : Json(nullptr)},
            {"inside", handle.inside},
            {"rim", pixel_json(handle.rim)}};
}

struct ProfileJson {
    Json operator()(const IsotropicProfileDesc& /*profile*/) const {
        return {{"type", "isotropic"}};
    }
    Json operator()(const SpotProfileDesc& profile) const {
        return {{"type", "spot"}, {"beam", profile.beam}, {"edge", profile.edge}};
    }
    Json operator()(const CosineProfileDesc& profile) const {
        return {{"type", "cosine"}, {"fwhm", profile.fwhm}};
    }
    Json operator()(const IesProfileDesc& profile) const {
        return {{"type", "ies"},
                {"file", profile.file.lexically_relative(folder).generic_string()},
                {"rotate", profile.rotate},
                {"tilt", profile.tilt}};
    }
    std::filesystem::path folder;
};

Json brightness_json(const LampDesc& lamp, const ConfigNode* entry) {
    Json brightness;
    if (lamp.sun && lamp.intensity)
        brightness = {
            {"kind", "irradiance"}, {"unit", "W/m2"}, {"value", list_json(*lamp.intensity)}};
    else if (lamp.sun)
        brightness = {{"kind", "lux"}, {"unit", "lx"}, {"value", *lamp.lumens}};
    else if (lamp.intensity)
        brightness = {
            {"kind", "intensity"}, {"unit", "W/sr"}, {"value", list_json(*lamp.intensity)}};
    else if (lamp.power)
        brightness = {{"kind", "power"}, {"unit", "W"}, {"value", list_json(*lamp.power)}};
    else if (lamp.lumens)
        brightness = {{"kind", "lumens"}, {"unit", "lm"}, {"value", *lamp.lumens}};
    else
        brightness = {{"kind", "profile"}, {"unit", nullptr}, {"value", nullptr}};
    // With a spectrum there is one number for all bands.
    if (lamp.spectrum && brightness["value"].is_array())
        brightness["value"] = brightness["value"][0];
    const ConfigNode* spectrum = entry ? entry->find("spectrum") : nullptr;
    brightness["spectrum"] = spectrum ? config_json(*spectrum) : Json(nullptr);
    return brightness;
}

// Why the editor does not change a lamp; empty if it does.
std::string reason_to_lock(const LampDesc& lamp, const ConfigNode* entry) {
    if (!entry) return "it comes from a glTF file, which is not written here";
    if (lamp.sun) return "it is a sun, which has no place; change it in the scene file";
    return "";
}

std::string_view frame_of(const SceneDesc& desc, const LampDesc& lamp, const ConfigNode* entry) {
    const ConfigNode* frame = entry ? entry->find("frame") : nullptr;
    if (frame && frame->scalar == "world") return "world";
    if (frame && frame->scalar == "rig") return "rig";
    if (lamp.sun) return "world";
    if (lamp.trajectory) return "trajectory";
    if (lamp.fixed_to_camera) return "camera";
    if (!entry) return "world";
    return frame || desc.cameras.empty() ? "camera" : "rig";
}

}  // namespace

Json lamp_json(const EditedScene& edited, std::size_t index, const ConfigNode& tree) {
    const SceneDesc& desc = edited.scene.desc();
    const LampDesc& lamp = desc.lamps[index];
    const EditedLamp& known = edited.lamps[index];
    const ConfigNode* entries = tree.find("lamps");
    const ConfigNode* entry = known.entry && entries ? &entries->items[*known.entry] : nullptr;
    const PlacedLamp placed = placed_lamp(lamp, desc.camera);
    Json cone = Json::array();
    for (const ImagePoint& point : beam_outline(*edited.camera, lamp, placed))
        cone.push_back(pixel_json(point));
    const auto half_angle = beam_half_angle(lamp.profile);
    const std::string why_not = reason_to_lock(lamp, entry);
    return {{"index", index},
            {"name", lamp.name},
            {"path", entry ? Json(fmt::format("lamps[{}]", *known.entry)) : Json(nullptr)},
            {"editable", why_not.empty()},
            {"why_not", why_not.empty() ? Json(nullptr) : Json(why_not)},
            {"on", known.on},
            {"frame", frame_of(desc, lamp, entry)},
            {"position", point_json(lamp.position)},
            {"direction", vector_json(lamp.direction)},
            {"world_position", point_json(placed.position)},
            {"world_direction", vector_json(placed.direction)},
            {"profile", lamp.sun ? Json{{"type", "sun"}}
                                 : std::visit(ProfileJson{desc.file.parent_path()}, lamp.profile)},
            {"half_angle", half_angle ? Json(*half_angle) : Json(nullptr)},
            {"brightness", brightness_json(lamp, entry)},
            {"band_intensity", list_json(known.brightness.first(edited.bands()))},
            {"rgb_scale", list_json(edited.colour_scale(known.brightness))},
            {"handle", handle_json(*edited.camera, placed.position)},
            {"axis_handle", handle_json(*edited.camera, axis_point(placed))},
            {"cone", std::move(cone)}};
}

Json lamp_spectrum_names_json() {
    Json names = Json::array(
        {{{"type", "flat"}}, {{"type", "d65"}}, {{"type", "blackbody"}, {"temperature", 3200}}});
    // The LEDs among the CIE's illuminants (CIE 15:2018).
    for (const std::string_view led : {"LED-B1", "LED-B2", "LED-B3", "LED-B4", "LED-B5", "LED-BH1",
                                       "LED-RGB1", "LED-V1", "LED-V2"})
        names.push_back({{"type", "led"}, {"name", led}});
    return names;
}

}  // namespace uw
