#include "edit/session/state_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include "edit/session/config_json.h"
#include "edit/session/lamp_json.h"
#include "edit/session/view_geometry.h"
#include "media/water/jerlov.h"

namespace uw {

namespace {

// Deeper and more, a folder is not one of lamps' files.
constexpr int k_folder_depth = 2;
constexpr std::size_t k_most_files = 200;

Json port_values_json(const FlatPortDesc& port) {
    return {{"type", "flat"},
            {"normal", vector_json(port.normal)},
            {"distance", port.distance},
            {"thickness", port.thickness},
            {"n_air", port.n_air},
            {"n_glass", port.n_glass},
            {"n_water", port.n_water},
            {"fresnel", port.fresnel}};
}

Json port_values_json(const DomePortDesc& port) {
    return {{"type", "dome"},          {"center", point_json(port.center)},
            {"radius", port.radius},   {"thickness", port.thickness},
            {"n_air", port.n_air},     {"n_glass", port.n_glass},
            {"n_water", port.n_water}, {"fresnel", port.fresnel}};
}

// With the path under which it can be edited; null where a calibration or a rig holds it.
Json port_json(const CameraDesc& camera, const ConfigNode& tree) {
    if (!camera.port) return nullptr;
    Json port = std::visit([](const auto& desc) { return port_values_json(desc); }, *camera.port);
    const ConfigNode* node = tree.find("camera");
    const bool is_written = node && node->find("port");
    port["path"] = is_written ? Json("camera.port") : Json(nullptr);
    return port;
}

Json camera_json(const EditedScene& edited, const ConfigNode& tree) {
    const SceneDesc& desc = edited.scene.desc();
    const Affine& world_from_camera = desc.camera.world_from_camera;
    Json frustum = Json::array();
    for (const Point3& corner : view_frustum(*edited.camera)) frustum.push_back(point_json(corner));
    const auto axis = [&](double x, double y, double z) {
        return vector_json(world_from_camera.apply_to_vector({x, y, z}));
    };
    return {{"name", desc.camera_name},
            {"position", point_json(world_from_camera * Point3{})},
            {"forward", axis(0, 0, 1)},
            {"right", axis(1, 0, 0)},
            {"up", axis(0, -1, 0)},
            {"frustum", std::move(frustum)},
            {"port", port_json(desc.camera, tree)}};
}

Json water_json(const SceneDesc& desc, const ConfigNode& tree) {
    const WaterDesc& water = desc.water;
    const auto optional = [](const std::optional<double>& value) {
        return value ? Json(*value) : Json(nullptr);
    };
    const ConfigNode* node = tree.find("water");
    return {
        {"preset", water.preset.empty() ? Json(nullptr) : Json(water.preset)},
        {"presets", jerlov_preset_names()},
        {"particles", {{"small", optional(water.small_ppm)}, {"large", optional(water.large_ppm)}}},
        {"salinity", water.salinity},
        {"temperature", water.temperature},
        {"path", "water"},
        {"keys", node ? config_json(*node) : Json::object()}};
}

std::string name_in_folder(const std::filesystem::path& file, const SceneDesc& desc) {
    return file.lexically_relative(desc.file.parent_path()).generic_string();
}

Json volumes_json(const SceneDesc& desc, const SceneShapes* shapes) {
    Json volumes = Json::array();
    for (std::size_t i = 0; i < desc.volumes.size(); ++i) {
        const VolumeDesc& volume = desc.volumes[i];
        Json concentrations = Json::object();
        for (const GridMappingDesc& grid : volume.grids)
            if (!grid.optics)
                concentrations[grid.grid] = {{"small", grid.small_ppm}, {"large", grid.large_ppm}};
        const bool has_bounds = shapes && i < shapes->volumes.size();
        volumes.push_back({{"index", i},
                           {"file", name_in_folder(volume.file, desc)},
                           {"path", fmt::format("volumes[{}]", i)},
                           {"bounds", has_bounds ? bounds_json(shapes->volumes[i]) : Json(nullptr)},
                           {"concentrations", std::move(concentrations)}});
    }
    return volumes;
}

Json ies_files_json(const SceneDesc& desc) {
    namespace fs = std::filesystem;
    std::vector<std::string> names;
    std::error_code error;
    fs::path folder = desc.file.parent_path();
    if (folder.empty()) folder = ".";
    for (auto at = fs::recursive_directory_iterator(
             folder, fs::directory_options::skip_permission_denied, error);
         !error && at != fs::recursive_directory_iterator() && names.size() < k_most_files;
         at.increment(error)) {
        if (at.depth() >= k_folder_depth) at.disable_recursion_pending();
        const std::string ending = at->path().extension().string();
        if (ending == ".ies" || ending == ".IES")
            names.push_back(at->path().lexically_relative(folder).generic_string());
    }
    std::ranges::sort(names);
    return names;
}

}  // namespace

Json outline_segments_json(const std::vector<OutlineSegment>& outlines) {
    Json segments = Json::array();
    for (const OutlineSegment& s : outlines)
        segments.push_back({s.from[0], s.from[1], s.from[2], s.to[0], s.to[1], s.to[2]});
    return segments;
}

Json scene_json(const EditedScene& edited, const ConfigNode& tree, const SceneShapes* shapes) {
    const SceneDesc& desc = edited.scene.desc();
    Json lamps = Json::array();
    for (std::size_t i = 0; i < desc.lamps.size(); ++i) lamps.push_back(lamp_json(edited, i, tree));
    return {{"image",
             {{"width", desc.camera.width},
              {"height", desc.camera.height},
              {"bands", list_json(desc.water.bands_nm)},
              {"bands_are_rgb", edited.has_plain_colour}}},
            {"warnings", edited.warnings},
            {"camera", camera_json(edited, tree)},
            {"rig", !desc.cameras.empty()},
            {"lamps", std::move(lamps)},
            {"ies_files", ies_files_json(desc)},
            {"spectra", lamp_spectrum_names_json()},
            {"water", water_json(desc, tree)},
            {"volumes", volumes_json(desc, shapes)}};
}

}  // namespace uw
