#include "cli/info/survey_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cli/grid_summary.h"
#include "cli/image_choice.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/light/integrator_table.h"

namespace uw {

namespace {

std::string per_band(const std::vector<double>& values) {
    std::string text;
    for (const double value : values)
        text += fmt::format("{}{}", text.empty() ? "" : ", ",
                            std::isfinite(value) ? fmt::format("{:.3g}", value) : "infinite");
    return text;
}

std::string percent(double share) {
    if (share > 0 && share < 0.001) return "under 0.1 %";
    return fmt::format("{:.3g} %", 100 * share);
}

std::string describe_water(const AssembledScene& scene) {
    const Medium& medium = scene.water.medium;
    std::string text = "water\n";
    for (int band = 0; band < medium.band_count(); ++band) {
        const double c = medium.uniform.attenuation(band);
        const double a = medium.uniform.absorption[static_cast<std::size_t>(band)];
        text += fmt::format("  {:g} nm: a {:.4g}, b {:.4g}, c {:.4g} 1/m\n",
                            medium.wavelengths_nm[static_cast<std::size_t>(band)], a, c - a, c);
    }
    return text;
}

// What `uwvdb render` will make of the scene.
std::string describe_render(const AssembledScene& scene) {
    const RenderDesc& render = scene.desc().render;
    std::string text = fmt::format(
        "render\n  integrator {}, quality {}: ", word_of(render.integrator, k_integrator_names),
        word_of(render.quality, k_quality_names));
    if (integrator_kind(render.integrator).traces_paths)
        text += fmt::format("all light, by {} random paths per pixel", samples_of(render));
    else if (scattering_of(render) == RenderDesc::Scattering::multiple)
        text += "all light; what is scattered or reflected more than once, with a standard error";
    else
        text += "light scattered once or reflected once";
    return text + "\n";
}

std::string describe_camera(const SceneSurvey& survey) {
    const CameraDesc& camera = survey.scene.desc().camera;
    const Vector3& at = camera.world_from_camera.offset();
    const Vector3 to = camera.world_from_camera.apply_to_vector({0, 0, 1});
    const std::string name = survey.scene.desc().camera_name;
    const double shutter = survey.scene.desc().render.shutter;
    std::string exposure;
    if (shutter > 0) exposure += fmt::format("  exposed for {:.4g} ms\n", 1e3 * shutter);
    if (camera.line_time > 0)
        exposure +=
            fmt::format("  a rolling shutter: {:.4g} us from row to row, {:.4g} ms in all\n",
                        1e6 * camera.line_time, 1e3 * camera.line_time * camera.height);
    return fmt::format(
        "camera{}\n  {} x {} pixels, {:.4g} x {:.4g} degrees in the water, {}\n"
        "  at ({:.4g}, {:.4g}, {:.4g}) looking along ({:.3g}, {:.3g}, {:.3g})\n{}",
        name.empty() ? "" : " '" + name + "', the first of the rig", camera.width, camera.height,
        survey.field_of_view[0], survey.field_of_view[1],
        camera.port ? "behind a port" : "without a port", at.x, at.y, at.z, to.x, to.y, to.z,
        exposure);
}

std::string describe_lamps(const AssembledScene& scene) {
    std::string text = scene.lamps.empty() ? "no lamps\n" : "lamps\n";
    for (const Lamp& lamp : scene.lamps) {
        std::vector<double> intensity(
            lamp.axis_intensity().begin(),
            lamp.axis_intensity().begin() + scene.water.medium.band_count());
        if (const Sunlight* const sun = lamp.sunlight()) {
            const Vector3& way = sun->direction;
            text += fmt::format("  {}: sun along ({:.3g}, {:.3g}, {:.3g}), {} W/m2\n", lamp.name(),
                                way.x, way.y, way.z, per_band(intensity));
            continue;
        }
        const Point3& at = lamp.position();
        text += fmt::format("  {}: {} at ({:.4g}, {:.4g}, {:.4g}), {} W/sr\n", lamp.name(),
                            lamp.profile_name(), at.x, at.y, at.z, per_band(intensity));
    }
    return text;
}

std::string describe_geometry(const AssembledScene& scene) {
    if (scene.desc().geometry.empty()) return "no geometry\n";
    std::string text = fmt::format("geometry\n  {} entries, {} triangles\n",
                                   scene.desc().geometry.size(), scene.surfaces->triangle_count());
    const Bounds b = scene.surfaces->bounds();
    if (!b.empty())
        text +=
            fmt::format("  finite parts x {:.4g}..{:.4g}, y {:.4g}..{:.4g}, z {:.4g}..{:.4g} m\n",
                        b.min.x, b.max.x, b.min.y, b.max.y, b.min.z, b.max.z);
    return text;
}

std::string describe_files(const std::vector<std::string>& outside) {
    if (outside.empty()) return {};
    constexpr std::size_t k_most = 20;
    std::string text = "files outside the scene's folder, which --confine refuses\n";
    for (std::size_t i = 0; i < std::min(k_most, outside.size()); ++i)
        text += "  " + outside[i] + "\n";
    if (outside.size() > k_most) text += fmt::format("  and {} more\n", outside.size() - k_most);
    return text;
}

std::string describe_view(const SceneSurvey& survey) {
    const CentralRaySurvey& ray = survey.central_ray;
    const ViewSurvey& view = survey.view;
    std::string text = "view\n";
    if (ray.enters && std::isfinite(ray.surface_distance))
        text += fmt::format(
            "  central ray: a surface after {:.4g} m; optical depth to it: water {}, "
            "volumes {}\n",
            ray.surface_distance, per_band(ray.water), per_band(ray.volumes));
    else if (ray.enters)
        text += fmt::format("  central ray: no surface; optical depth of the volumes {}\n",
                            per_band(ray.volumes));
    else
        text += "  central ray: does not enter the water\n";
    if (view.on_surface > 0)
        text += fmt::format(
            "  surfaces on {} of the image, {:.4g} to {:.4g} m away; {} of them in reach of a "
            "lamp\n",
            percent(view.on_surface), view.nearest, view.farthest, percent(view.lit));
    return text;
}

std::string describe_sequences(const SceneSurvey& survey) {
    std::string text;
    for (const SequenceReport& s : survey.sequences) {
        text += fmt::format("sequence {}: frame {} of {}\n", s.pattern, s.frame,
                            format_frame_list(s.found));
        if (!s.missing.empty())
            text += "  missing between them: " + format_frame_list(s.missing) + "\n";
    }
    return text;
}

std::string variations_text(const VariationsSurvey& survey) {
    std::string text = fmt::format("variations, seed {}\n", survey.desc.seed);
    for (const DrawnKey& key : survey.desc.keys)
        text += fmt::format("  {}: {}\n", key.key, key.text);
    for (const DrawnRows& together : survey.desc.together)
        text += fmt::format("  {}: together, one of {} rows\n", fmt::join(together.keys, ", "),
                            together.rows.size());
    for (std::size_t i = 0; i < survey.first.size(); ++i)
        text += fmt::format("  variation {}: {}\n", i, values_text(survey.first[i]));
    return text;
}

}  // namespace

std::string survey_text(const SceneSurvey& survey) {
    const AssembledScene& scene = survey.scene;
    std::string text = describe_sequences(survey);
    text += describe_water(scene) + describe_camera(survey) + describe_lamps(scene) +
            describe_geometry(scene) + describe_render(scene);
    if (survey.grids.empty()) text += "no volumes\n";
    for (const GridSurvey& grid : survey.grids) {
        text += describe_grid(grid.report, scene.water.medium);
        text += fmt::format("  in view {}, in reach of a lamp {}, both {}\n", percent(grid.in_view),
                            percent(grid.in_reach), percent(grid.in_both));
    }
    text += describe_files(survey.files_outside) + describe_view(survey);
    if (survey.path) text += path_text(*survey.path);
    if (survey.variations) text += variations_text(*survey.variations);
    if (survey.contrast)
        text += fmt::format(
            "  contrast of the volumes {}, where they are seen ({} of the image; a draft with and "
            "without them, 99th percentile)\n",
            percent(survey.contrast->contrast), percent(survey.contrast->seen));
    text += fmt::format(
        "(in reach: inside a lamp's beam, behind no surface, and its light arrives with more than "
        "{:g} of what it gives at 1 m on its axis)\n",
        k_reach);
    for (const std::string& warning : survey.warnings) text += "warning: " + warning + "\n";
    return text;
}

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
    const std::string& name = survey.scene.desc().camera_name;
    return name.empty() ? Json(nullptr) : Json(name);
}

Json camera(const SceneSurvey& survey) {
    const CameraDesc& desc = survey.scene.desc().camera;
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
    json["scene"] = scene.desc().file.string();
    json["sequences"] = Json::array();
    for (const SequenceReport& s : survey.sequences)
        json["sequences"].push_back({{"pattern", s.pattern},
                                     {"frame", s.frame},
                                     {"found", s.found},
                                     {"missing", s.missing}});
    json["water"] = water(scene);
    json["camera"] = camera(survey);
    json["lamps"] = lamps(scene);
    json["geometry"] = {{"entries", scene.desc().geometry.size()},
                        {"triangles", scene.surfaces->triangle_count()},
                        {"bounds", bounds_json(scene.surfaces->bounds())}};
    json["render"] = render(scene.desc().render);
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
