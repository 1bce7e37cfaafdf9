#include "cli/info/survey_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "cli/grid_summary.h"
#include "cli/image_choice.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "core/base/version.h"
#include "core/geometry/waves.h"
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

std::string percent(double fraction) {
    if (fraction > 0 && fraction < 0.001) return "under 0.1 %";
    return fmt::format("{:.3g} %", 100 * fraction);
}

Report report_on_water(const AssembledScene& scene) {
    const Medium& medium = scene.water.medium;
    Report report("water");
    std::vector<double> a, b, c;
    for (int band = 0; band < medium.band_count(); ++band) {
        const auto i = static_cast<std::size_t>(band);
        c.push_back(medium.uniform.attenuation(band));
        a.push_back(medium.uniform.absorption[i]);
        b.push_back(c[i] - a[i]);
        report.say(fmt::format("{:g} nm: a {:.4g}, b {:.4g}, c {:.4g} 1/m",
                               medium.wavelengths_nm[i], a[i], b[i], c[i]));
    }
    report.set({{"wavelengths_nm", medium.wavelengths_nm},
                {"a", list_json(a)},
                {"b", list_json(b)},
                {"c", list_json(c)}});
    Report by_depth;
    Json depths = Json::array(), attenuation = Json::array();
    const std::vector<OpticalCoefficients> all = coefficients_by_depth(scene.water);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Spectrum there = all[i].attenuation();
        const std::vector<double> values(there.begin(), there.begin() + medium.band_count());
        depths.push_back(scene.water.strata->depths()[i]);
        attenuation.push_back(list_json(values));
        constexpr std::size_t k_most = 20;
        if (i < k_most)
            by_depth.say(
                fmt::format("  {:.4g} m: c {}", scene.water.strata->depths()[i], per_band(values)));
        else if (i == k_most)
            by_depth.say(fmt::format("  and {} more depths", all.size() - k_most));
    }
    if (!all.empty()) {
        report.say(fmt::format("is the least of what changes with depth; by {}:",
                               scene.desc().water.profile->file.filename().string()));
        report.add("by_depth", by_depth);
    }
    report.set({{"depths_m", std::move(depths)}, {"c_at_depths", std::move(attenuation)}});
    return report;
}

Report report_on_surface(const AssembledScene& scene) {
    Report report("the water's surface");
    const WaterSurface& surface = *scene.water_surface;
    Json waves = nullptr;
    if (surface.has_waves()) {
        const WaveStatistics all = surface.waves()->statistics();
        report.say(
            fmt::format("waves with a significant height of {:.3g} m, mean square slope "
                        "{:.3g}",
                        all.significant_height(), all.slopes.total()));
        if (const auto* sea =
                std::get_if<WaveSpectrumDesc>(&scene.desc().water.surface->waves->shape))
            report.say(compare_with_cox_munk(*sea, *surface.waves()));
        waves = {{"significant_height", all.significant_height()},
                 {"mean_square_slope", all.slopes.total()}};
    } else {
        report.say("calm");
    }
    report.set({{"n", surface.n()}, {"waves", std::move(waves)}});
    return report;
}

Report report_on_camera(const SceneSurvey& survey) {
    const CameraDesc& camera = survey.scene.desc().camera;
    const Vector3& at = camera.world_from_camera.offset();
    const Vector3 to = camera.world_from_camera.apply_to_vector({0, 0, 1});
    const std::string& name = survey.scene.desc().camera_name;
    Report report("camera" + (name.empty() ? name : " '" + name + "', the first of the rig"));
    report.say(fmt::format("{} x {} pixels, {:.4g} x {:.4g} degrees in the water, {}", camera.width,
                           camera.height, survey.field_of_view[0], survey.field_of_view[1],
                           camera.port ? "behind a port" : "without a port"));
    report.say(fmt::format("at ({:.4g}, {:.4g}, {:.4g}) looking along ({:.3g}, {:.3g}, {:.3g})",
                           at.x, at.y, at.z, to.x, to.y, to.z));
    report.set({{"name", name.empty() ? Json(nullptr) : Json(name)},
                {"resolution", {camera.width, camera.height}},
                {"field_of_view_deg", list_json(survey.field_of_view)},
                {"port", camera.port.has_value()},
                {"position", vector_json(at)},
                {"direction", vector_json(to)}});
    if (disperses(camera)) {
        report.say(fmt::format("rays and ground truth of light of {:g} nm; lateral colour {}",
                               camera.wavelength_nm, text_of(survey.lateral_colour)));
        if (survey.colour_groups > 1)
            report.say(fmt::format(
                "rendered {} times, as many groups of bands have rays of their own; with numbers "
                "for n_glass and n_water once",
                survey.colour_groups));
        Json shifts = Json::array();
        for (const BandShift& shift : survey.lateral_colour)
            shifts.push_back({{"wavelength_nm", shift.wavelength_nm}, {"pixels", shift.pixels}});
        report.set({{"wavelength_nm", camera.wavelength_nm},
                    {"lateral_colour", shifts},
                    {"colour_groups", survey.colour_groups}});
    }
    const double shutter = survey.scene.desc().render.shutter;
    if (shutter > 0) report.say(fmt::format("exposed for {:.4g} ms", 1e3 * shutter));
    if (camera.line_time > 0)
        report.say(fmt::format("a rolling shutter: {:.4g} us from row to row, {:.4g} ms in all",
                               1e6 * camera.line_time, 1e3 * camera.line_time * camera.height));
    return report;
}

Report report_on_lamp(const Lamp& lamp, int band_count) {
    Report report;
    const std::vector<double> intensity(lamp.axis_intensity().begin(),
                                        lamp.axis_intensity().begin() + band_count);
    report.set({{"name", lamp.name()}});
    if (const Sunlight* const sun = lamp.sunlight()) {
        const Vector3& way = sun->direction;
        report.say(fmt::format("{}: sun along ({:.3g}, {:.3g}, {:.3g}), {} W/m2", lamp.name(),
                               way.x, way.y, way.z, per_band(intensity)));
        report.set({{"direction", vector_json(way)}, {"irradiance", list_json(intensity)}});
        return report;
    }
    const Point3& at = lamp.position();
    report.say(fmt::format("{}: {} at ({:.4g}, {:.4g}, {:.4g}), {} W/sr", lamp.name(),
                           lamp.profile_name(), at.x, at.y, at.z, per_band(intensity)));
    report.set({{"position", point_json(at)}, {"axis_intensity", list_json(intensity)}});
    return report;
}

Report report_on_geometry(const AssembledScene& scene) {
    const std::size_t entries = scene.desc().geometry.size();
    Report report(entries == 0 ? "no geometry" : "geometry");
    const auto triangles = scene.surfaces->triangle_count();
    const Bounds bounds = scene.surfaces->bounds();
    if (entries > 0)
        report.say(fmt::format("{} {}, {}", entries, entries == 1 ? "entry" : "entries",
                               counted(triangles, "triangle")));
    if (entries > 0 && !bounds.empty()) report.say("finite parts " + bounds_text(bounds));
    report.set({{"entries", entries}, {"triangles", triangles}, {"bounds", bounds_json(bounds)}});
    return report;
}

/// How `uwvdb render` will render the scene.
Report report_on_render(const SceneSurvey& survey) {
    const RenderDesc& render = survey.scene.desc().render;
    const std::string integrator = word_of(render.integrator, k_integrator_names);
    const std::string quality = word_of(render.quality, k_quality_names);
    Report report("render");
    std::string light = "light scattered once or reflected once";
    if (integrator_kind(render.integrator).traces_paths)
        light = fmt::format("all light, by {} random paths per pixel", samples_of(render));
    else if (scattering_of(render) == RenderDesc::Scattering::multiple)
        light = "all light; what is scattered or reflected more than once, with a standard error";
    if (survey.left_out)
        light += fmt::format(", which leaves out about {} of all light",
                             percent(survey.left_out->fraction));
    report.say(fmt::format("integrator {}, quality {}: {}", integrator, quality, light));
    report.set({{"integrator", integrator},
                {"scattering", word_of(scattering_of(render), k_scattering_names)},
                {"quality", quality},
                {"samples", samples_of(render)},
                {"light_left_out", survey.left_out ? Json(survey.left_out->fraction) : Json()}});
    return report;
}

Report report_on_sequence(const SequenceReport& s) {
    Report report(
        fmt::format("sequence {}: frame {} of {}", s.pattern, s.frame, format_frame_list(s.found)));
    if (!s.missing.empty()) report.say("missing between them: " + format_frame_list(s.missing));
    report.set(
        {{"pattern", s.pattern}, {"frame", s.frame}, {"found", s.found}, {"missing", s.missing}});
    return report;
}

Report report_on_grid(const GridSurvey& grid, const Medium& medium) {
    Report report = report_on_grid(grid.report, medium);
    report.say(fmt::format("in view {}, in reach of a lamp {}, both {}", percent(grid.in_view),
                           percent(grid.in_reach), percent(grid.in_both)));
    if (!grid.hidden_behind.empty())
        report.say(fmt::format("hidden behind {}: {}", grid.hidden_behind, percent(grid.hidden)));
    report.set(
        {{"in_view", grid.in_view},
         {"in_reach", grid.in_reach},
         {"in_both", grid.in_both},
         {"hidden", grid.hidden},
         {"hidden_behind", grid.hidden_behind.empty() ? Json(nullptr) : Json(grid.hidden_behind)}});
    return report;
}

Report report_on_central_ray(const CentralRaySurvey& ray) {
    Report report;
    if (!ray.enters)
        report.say("central ray: does not enter the water");
    else if (std::isfinite(ray.surface_distance))
        report.say(fmt::format(
            "central ray: a surface after {:.4g} m; optical depth to it: water {}, volumes {}",
            ray.surface_distance, per_band(ray.water), per_band(ray.volumes)));
    else
        report.say("central ray: no surface; optical depth of the volumes " +
                   per_band(ray.volumes));
    report.set({{"enters_water", ray.enters},
                {"surface_distance", number_json(ray.surface_distance)},
                {"optical_depth_water", list_json(ray.water)},
                {"optical_depth_volumes", list_json(ray.volumes)}});
    return report;
}

Report report_on_view(const ViewSurvey& view) {
    Report report;
    if (view.on_surface > 0)
        report.say(fmt::format(
            "surfaces on {} of the image, {:.4g} to {:.4g} m away; {} of them in reach of a lamp",
            percent(view.on_surface), view.nearest, view.farthest, percent(view.lit)));
    report.set({{"in_water", view.in_water},
                {"on_surface", view.on_surface},
                {"lit", view.lit},
                {"hidden", view.hidden},
                {"nearest", view.nearest},
                {"farthest", view.farthest}});
    return report;
}

Report report_on_contrast(const DraftContrast& draft) {
    Report report;
    report.say(fmt::format(
        "contrast of the volumes {}, where they are seen ({} of the image; a draft with and "
        "without them, 99th percentile), median {}",
        percent(draft.contrast), percent(draft.seen), percent(draft.median_contrast)));
    report.set({{"contrast", draft.contrast},
                {"median_contrast", draft.median_contrast},
                {"seen", draft.seen},
                {"brightness", draft.brightness},
                {"optical_depth", draft.depth}});
    return report;
}

Report report_on_variations(const VariationsSurvey& survey) {
    Report report(fmt::format("variations, seed {}", survey.desc.seed));
    report.set({{"seed", survey.desc.seed}});
    std::vector<Report> keys, together;
    for (const DrawnKey& key : survey.desc.keys) {
        Report& part = keys.emplace_back();
        part.say(key.key + ": " + key.text);
        part.set({{"key", key.key}, {"drawn_from", key.text}});
    }
    for (const DrawnRows& rows : survey.desc.together) {
        Report& part = together.emplace_back();
        part.say(fmt::format("{}: together, one of {}", fmt::join(rows.keys, ", "),
                             counted(rows.rows.size(), "row")));
        part.set({{"keys", rows.keys}, {"rows", rows.rows.size()}});
    }
    report.add("keys", keys);
    report.add("together", together);
    Json first = Json::array();
    for (const std::vector<DrawnValue>& values : survey.first) {
        report.say(fmt::format("variation {}: {}", first.size(), values_text(values)));
        Json& of_one = first.emplace_back(Json::array());
        for (const DrawnValue& value : values) of_one.push_back(value.override_text());
    }
    report.set({{"first", std::move(first)}});
    return report;
}

void add_files_outside(const std::vector<std::string>& outside, Report& report) {
    report.set({{"files_outside", outside}});
    if (outside.empty()) return;
    constexpr std::size_t k_most = 20;
    report.say("files outside the scene's folder, which --confine refuses");
    for (std::size_t i = 0; i < std::min(k_most, outside.size()); ++i)
        report.say("  " + outside[i]);
    if (outside.size() > k_most) report.say(fmt::format("  and {} more", outside.size() - k_most));
}

}  // namespace

Report report_on_scene(const SceneSurvey& survey) {
    const AssembledScene& scene = survey.scene;
    const Medium& medium = scene.water.medium;
    Report report;
    report.set({{"uwvdb", program_version()}, {"scene", scene.desc().file.string()}});
    std::vector<Report> sequences, lamps, grids;
    for (const SequenceReport& s : survey.sequences) sequences.push_back(report_on_sequence(s));
    for (const Lamp& lamp : scene.lamps) lamps.push_back(report_on_lamp(lamp, medium.band_count()));
    for (const GridSurvey& grid : survey.grids) grids.push_back(report_on_grid(grid, medium));
    report.add("sequences", sequences);
    report.add("water", report_on_water(scene));
    if (scene.water_surface) report.add("surface", report_on_surface(scene));
    report.add("camera", report_on_camera(survey));
    report.add("lamps", lamps, lamps.empty() ? "no lamps" : "lamps");
    report.add("geometry", report_on_geometry(scene));
    report.add("render", report_on_render(survey));
    report.add("grids", grids, grids.empty() ? "no volumes" : "");
    report.add("central_ray", report_on_central_ray(survey.central_ray));
    report.add("view", report_on_view(survey.view));
    const auto add = [&](const char* key, const auto& found, const auto& report_on) {
        if (found)
            report.add(key, report_on(*found));
        else
            report.set({{key, nullptr}});
    };
    add("contrast", survey.contrast, report_on_contrast);
    add("path", survey.path, report_on_path);
    add("variations", survey.variations, report_on_variations);
    report.say(fmt::format(
        "(in reach: inside a lamp's beam, behind no surface, and its light arrives with more than "
        "{:g} of what it gives at 1 m on its axis)",
        k_reach));
    report.set({{"reach", k_reach}});
    add_files_outside(survey.files_outside, report);
    for (const std::string& warning : survey.warnings) report.say("warning: " + warning);
    report.set({{"warnings", survey.warnings}});
    return report;
}

}  // namespace uw
