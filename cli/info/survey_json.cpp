#include "cli/info/survey_json.h"

#include "core/base/text.h"
#include "core/base/version.h"
#include "core/integrators/integrator_table.h"
#include "core/json/json.h"

namespace uw {

namespace {

Json water(const AssembledScene& scene) {
    const Medium& medium = scene.water.medium;
    std::vector<double> a, b, c;
    for (int band = 0; band < medium.band_count(); ++band) {
        c.push_back(medium.uniform.attenuation(band));
        a.push_back(medium.uniform.absorption[static_cast<std::size_t>(band)]);
        b.push_back(c.back() - a.back());
    }
    return {{"wavelengths_nm", medium.wavelengths_nm},
            {"a", list_json(a)},
            {"b", list_json(b)},
            {"c", list_json(c)}};
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
            {"field_of_view_deg", list_json(survey.field_of_view)},
            {"port", desc.port.has_value()},
            {"position", vector_json(at)},
            {"direction", vector_json(to)}};
}

Json lamps(const AssembledScene& scene) {
    Json out = Json::array();
    for (const Lamp& lamp : scene.lamps) {
        std::vector<double> intensity(
            lamp.axis_intensity().begin(),
            lamp.axis_intensity().begin() + scene.water.medium.band_count());
        if (const Sunlight* const sun = lamp.sunlight())
            out.push_back({{"name", lamp.name()},
                           {"direction", vector_json(sun->direction)},
                           {"irradiance", list_json(intensity)}});
        else
            out.push_back({{"name", lamp.name()},
                           {"position", point_json(lamp.position())},
                           {"axis_intensity", list_json(intensity)}});
    }
    return out;
}

Json render(const RenderDesc& desc) {
    return {{"integrator", word_of(desc.integrator, k_integrator_names)},
            {"scattering", word_of(scattering_of(desc), k_scattering_names)},
            {"quality", word_of(desc.quality, k_quality_names)},
            {"samples", samples_of(desc)}};
}

Json grid_json(const GridSurvey& grid, const Medium& medium) {
    const VolumeReport& r = grid.report;
    Json out;
    out["file"] = r.file.string();
    out["grid"] = r.grid;
    out["metres_per_voxel"] = vector_json(r.metres_per_voxel);
    out["world_bounds"] = bounds_json(r.bounds);
    out["active_voxels"] = r.statistics.active_voxels;
    out["up"] = r.placement.up == UpAxis::z ? "z" : "y";
    out["centering"] = r.placement.centering == Centering::cell ? "cell" : "node";
    out["constituents"] = Json::array();
    for (const ConstituentReport& c : r.constituents) {
        const Constituent& constituent =
            medium.constituents[static_cast<std::size_t>(c.constituent)];
        out["constituents"].push_back({{"name", constituent.name},
                                       {"unit", constituent.unit},
                                       {"min", number_json(c.min)},
                                       {"mean", number_json(c.mean)},
                                       {"max", number_json(c.max)}});
    }
    out["optical_depth"] = {{"x", list_json(grid.depth[0])},
                            {"y", list_json(grid.depth[1])},
                            {"z", list_json(grid.depth[2])}};
    out["in_view"] = grid.in_view;
    out["in_reach"] = grid.in_reach;
    out["in_both"] = grid.in_both;
    return out;
}

Json contrast_json(const std::optional<DraftContrast>& contrast) {
    if (!contrast) return nullptr;
    return {{"contrast", contrast->contrast},
            {"seen", contrast->seen},
            {"brightness", contrast->brightness},
            {"optical_depth", contrast->depth}};
}

Json path_json(const std::optional<PathSurvey>& path) {
    if (!path) return nullptr;
    Json points = Json::array();
    for (const PathPoint& point : path->points)
        points.push_back({{"frame", point.frame},
                          {"time", point.time},
                          {"position", point_json(point.position)},
                          {"height", number_json(point.height)}});
    const auto frame = [&](const std::optional<std::size_t>& index) {
        return index ? Json(path->points[*index].frame) : Json(nullptr);
    };
    return {{"first_frame", path->frames.first},
            {"last_frame", path->frames.last},
            {"length", path->length},
            {"top_speed", path->top_speed},
            {"leaves_floor", frame(path->leaves_floor)},
            {"enters", frame(path->enters)},
            {"entered", path->entered},
            {"points", std::move(points)}};
}

Json variations_json(const std::optional<VariationsSurvey>& survey) {
    if (!survey) return nullptr;
    Json keys = Json::array();
    for (const DrawnKey& key : survey->desc.keys)
        keys.push_back({{"key", key.key}, {"drawn_from", key.text}});
    Json together = Json::array();
    for (const DrawnRows& rows : survey->desc.together)
        together.push_back({{"keys", rows.keys}, {"rows", rows.rows.size()}});
    Json first = Json::array();
    for (const std::vector<DrawnValue>& values : survey->first) {
        Json& of_one = first.emplace_back(Json::array());
        for (const DrawnValue& value : values) of_one.push_back(value.override_text());
    }
    return {{"seed", survey->desc.seed},
            {"keys", std::move(keys)},
            {"together", std::move(together)},
            {"first", std::move(first)}};
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
                        {"bounds", bounds_json(scene.surfaces->bounds())}};
    json["render"] = render(scene.desc.render);
    json["grids"] = Json::array();
    for (const GridSurvey& grid : survey.grids)
        json["grids"].push_back(grid_json(grid, scene.water.medium));
    const CentralRaySurvey& ray = survey.central_ray;
    json["central_ray"] = {{"enters_water", ray.enters},
                           {"surface_distance", number_json(ray.surface_distance)},
                           {"optical_depth_water", list_json(ray.water)},
                           {"optical_depth_volumes", list_json(ray.volumes)}};
    const ViewSurvey& view = survey.view;
    json["view"] = {{"in_water", view.in_water}, {"on_surface", view.on_surface},
                    {"lit", view.lit},           {"hidden", view.hidden},
                    {"nearest", view.nearest},   {"farthest", view.farthest}};
    json["contrast"] = contrast_json(survey.contrast);
    json["path"] = path_json(survey.path);
    json["variations"] = variations_json(survey.variations);
    json["reach"] = k_reach;
    json["files_outside"] = survey.files_outside;
    json["warnings"] = survey.warnings;
    return json_text(json);
}

}  // namespace uw
