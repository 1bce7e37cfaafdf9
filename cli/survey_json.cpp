#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/scene_survey.h"
#include "cli/version.h"

namespace uw {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json list(const std::vector<double>& values) {
    Json out = Json::array();
    for (const double value : values) out.push_back(number(value));
    return out;
}

Json triple(double x, double y, double z) {
    return list({x, y, z});
}

Json water(const AssembledScene& scene) {
    const Medium& medium = scene.water.medium;
    std::vector<double> a, b, c;
    for (int band = 0; band < medium.band_count(); ++band) {
        c.push_back(medium.uniform.attenuation(band));
        a.push_back(medium.uniform.absorption[static_cast<std::size_t>(band)]);
        b.push_back(c.back() - a.back());
    }
    return {
        {"wavelengths_nm", medium.wavelengths_nm}, {"a", list(a)}, {"b", list(b)}, {"c", list(c)}};
}

/// Of a rig's camera; null without a rig.
Json camera_name(const SceneSurvey& survey) {
    const std::string& name = survey.scene.desc.camera_name;
    return name.empty() ? Json(nullptr) : Json(name);
}

Json camera(const SceneSurvey& survey) {
    const CameraDesc& desc = survey.scene.desc.camera;
    const Vector3& at = desc.world_from_camera.offset();
    const Vector3 to = desc.world_from_camera.apply_to_vector({0, 0, 1});
    return {{"name", camera_name(survey)},
            {"resolution", {desc.width, desc.height}},
            {"field_of_view_deg", list({survey.field_of_view[0], survey.field_of_view[1]})},
            {"port", desc.port.has_value()},
            {"position", triple(at.x, at.y, at.z)},
            {"direction", triple(to.x, to.y, to.z)}};
}

Json lamps(const AssembledScene& scene) {
    Json out = Json::array();
    for (const Lamp& lamp : scene.lamps) {
        const Point3& at = lamp.position();
        std::vector<double> intensity(
            lamp.axis_intensity().begin(),
            lamp.axis_intensity().begin() + scene.water.medium.band_count());
        out.push_back({{"name", lamp.name()},
                       {"position", triple(at.x, at.y, at.z)},
                       {"axis_intensity", list(intensity)}});
    }
    return out;
}

Json bounds(const Bounds& b) {
    if (b.empty()) return nullptr;
    return {{"min", triple(b.min.x, b.min.y, b.min.z)}, {"max", triple(b.max.x, b.max.y, b.max.z)}};
}

Json grid_json(const GridSurvey& grid, const Medium& medium) {
    const VolumeReport& r = grid.report;
    Json out;
    out["file"] = r.file.string();
    out["grid"] = r.grid;
    out["metres_per_voxel"] =
        triple(r.metres_per_voxel.x, r.metres_per_voxel.y, r.metres_per_voxel.z);
    out["world_bounds"] = bounds(r.bounds);
    out["active_voxels"] = r.statistics.active_voxels;
    out["up"] = r.placement.up == UpAxis::z ? "z" : "y";
    out["centering"] = r.placement.centering == Centering::cell ? "cell" : "node";
    out["constituents"] = Json::array();
    for (const ConstituentReport& c : r.constituents) {
        const Constituent& constituent =
            medium.constituents[static_cast<std::size_t>(c.constituent)];
        out["constituents"].push_back({{"name", constituent.name},
                                       {"unit", constituent.unit},
                                       {"min", number(c.min)},
                                       {"mean", number(c.mean)},
                                       {"max", number(c.max)}});
    }
    out["optical_depth"] = {
        {"x", list(grid.depth[0])}, {"y", list(grid.depth[1])}, {"z", list(grid.depth[2])}};
    out["in_view"] = grid.in_view;
    out["in_reach"] = grid.in_reach;
    out["in_both"] = grid.in_both;
    return out;
}

}  // namespace

std::string survey_json(const SceneSurvey& survey) {
    const AssembledScene& scene = survey.scene;
    Json json;
    json["uwvdb"] = program_version();
    json["scene"] = scene.desc.file.string();
    json["sequences"] = Json::array();
    for (const SequenceReport& s : survey.sequences)
        json["sequences"].push_back({{"pattern", s.pattern},
                                     {"frame", s.frame},
                                     {"found", s.found},
                                     {"missing", s.missing}});
    json["water"] = water(scene);
    json["camera"] = camera(survey);
    json["lamps"] = lamps(scene);
    json["geometry"] = {{"entries", scene.desc.geometry.size()},
                        {"triangles", scene.surfaces->triangle_count()},
                        {"bounds", bounds(scene.surfaces->bounds())}};
    json["grids"] = Json::array();
    for (const GridSurvey& grid : survey.grids)
        json["grids"].push_back(grid_json(grid, scene.water.medium));
    const CentralRaySurvey& ray = survey.central_ray;
    json["central_ray"] = {{"enters_water", ray.enters},
                           {"surface_distance", number(ray.surface_distance)},
                           {"optical_depth_water", list(ray.water)},
                           {"optical_depth_volumes", list(ray.volumes)}};
    const ViewSurvey& view = survey.view;
    json["view"] = {{"in_water", view.in_water}, {"on_surface", view.on_surface},
                    {"lit", view.lit},           {"hidden", view.hidden},
                    {"nearest", view.nearest},   {"farthest", view.farthest}};
    json["reach"] = k_reach;
    json["warnings"] = survey.warnings;
    // Names come from users' files and need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace uw
