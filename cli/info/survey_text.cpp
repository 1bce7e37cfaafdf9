#include "cli/info/survey_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cli/frame_list.h"
#include "cli/grid_summary.h"
#include "core/base/text.h"
#include "core/integrators/integrator_table.h"

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
    const RenderDesc& render = scene.desc.render;
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
    const CameraDesc& camera = survey.scene.desc.camera;
    const Vector3& at = camera.world_from_camera.offset();
    const Vector3 to = camera.world_from_camera.apply_to_vector({0, 0, 1});
    const std::string name = survey.scene.desc.camera_name;
    const double shutter = survey.scene.desc.render.shutter;
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
    if (scene.desc.geometry.empty()) return "no geometry\n";
    std::string text = fmt::format("geometry\n  {} entries, {} triangles\n",
                                   scene.desc.geometry.size(), scene.surfaces->triangle_count());
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

}  // namespace uw
