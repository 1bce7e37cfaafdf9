#include "cli/info/scene_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "cli/grid_summary.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/base/troubleshooting.h"
#include "core/light/medium.h"
#include "render/light_points.h"
#include "render/scene_assembly.h"
#include "render/scene_rendering.h"

namespace uw {

namespace {

constexpr double k_invisible_depth = 0.01;
// Anything behind this optical depth is taken to be black.
constexpr double k_opaque_depth = 10;
// A fraction of a grid in view that is most likely a mistake.
constexpr double k_little_in_view = 1e-3;

void warn_of_grid(const GridSurvey& grid, bool has_lamps, std::vector<std::string>& warnings) {
    const std::string name = fmt::format("grid '{}' of '{}': ", grid.report.grid,
                                         printable(grid.report.file.filename().string(), 300));
    const auto warn_missing = [&](const std::string& what) {
        warnings.push_back(name + what + see_troubleshooting("The plume is missing"));
    };
    const auto warn_black = [&](const std::string& what) {
        warnings.push_back(name + what + see_troubleshooting("Black"));
    };
    if (grid.report.bounds.empty()) return;  // loading has warned of it
    if (grid.in_view < k_little_in_view && grid.hidden > grid.in_view)
        warn_missing(fmt::format(
            "hidden behind {}: {:.3g} % of it is in the image, but behind that surface; "
            "if it is the box of a simulation, leave it out of the geometry, else move "
            "the camera",
            grid.hidden_behind, 100 * grid.hidden));
    else if (grid.in_view == 0)
        warn_missing(
            "nothing of it is in view of the camera; compare its world bounds with camera.pose, "
            "and give it a transform");
    else if (grid.in_view < k_little_in_view)
        warn_missing(
            fmt::format("only {:.2g} % of it is in view of the camera; compare its world bounds "
                        "with camera.pose, and give it a transform",
                        100 * grid.in_view));
    if (has_lamps && grid.in_reach == 0)
        warn_black(
            "no lamp reaches any of it: it will be black; move a lamp nearer, or aim it there");
    else if (has_lamps && grid.in_view > 0 && grid.in_both == 0)
        warn_black("no lamp reaches what is in view of it: it will be black");
    double most = 0, least = 1e300;
    for (const std::vector<double>& depth : grid.depth) {
        most = std::max(most, std::ranges::max(depth));
        least = std::min(least, std::ranges::min(depth));
    }
    if (most < k_invisible_depth)
        warn_missing(
            fmt::format("its optical depth is {:.2g} at most: it will be invisible; raise the ppm "
                        "per unit, or check transform.scale",
                        most));
    if (least > k_opaque_depth)
        warn_missing(
            fmt::format("its optical depth is {:.3g} or more along every axis: it is opaque; lower "
                        "the ppm per unit, or check transform.scale",
                        least));
}

void warn_of_surfaces(const SceneSurvey& survey, std::vector<std::string>& warnings) {
    const ViewSurvey& view = survey.view;
    if (view.on_surface == 0) return;
    if (!survey.scene.lamps.empty() && view.lit == 0)
        warnings.push_back(
            "no lamp reaches any surface in view: they will be black; move a lamp nearer, or aim "
            "it there" +
            see_troubleshooting("Black"));
    if (view.hidden == 1)
        warnings.push_back(fmt::format(
            "every surface in view lies behind an optical depth over {:g} in all bands: none will "
            "be seen; go nearer, or make the water or the volumes clearer{}",
            k_opaque_depth, see_troubleshooting("Black")));
    else if (view.hidden > 0.5)
        warnings.push_back(fmt::format(
            "{:.0f} % of the surfaces in view lie behind an optical depth over {:g} in all bands",
            100 * view.hidden, k_opaque_depth));
}

/// The reasons why volumes in view are hard to see, with hints.
void warn_of_contrast(const SceneSurvey& survey, std::vector<std::string>& warnings) {
    if (!survey.contrast || survey.contrast->seen == 0) return;
    const DraftContrast& draft = *survey.contrast;
    if (draft.contrast >= k_hardly_seen) return;
    constexpr double k_thin = 0.5;
    warnings.push_back(fmt::format(
        "the volumes change the picture by {:.2g} % where they are seen (99th percentile): they "
        "will hardly be noticed; {}{}",
        100 * draft.contrast,
        draft.depth < k_thin
            ? fmt::format("their optical depth there is {:.2g}: raise the ppm per unit, or check "
                          "transform.scale",
                          draft.depth)
            : "move the lamps away from the camera and nearer to the volumes, so that less water "
              "is lit before them, go nearer with the camera, or make the water clearer",
        see_troubleshooting("The plume is missing")));
}

/// One line for each thing that will be black, opaque or missing.
void append_survey_warnings(SceneSurvey& survey) {
    std::vector<std::string>& warnings = survey.warnings;
    const bool has_lamps = !survey.scene.lamps.empty();
    for (const GridSurvey& grid : survey.grids) warn_of_grid(grid, has_lamps, warnings);
    warn_of_surfaces(survey, warnings);
    warn_of_contrast(survey, warnings);
    const bool grid_in_view =
        std::ranges::any_of(survey.grids, [](const GridSurvey& grid) { return grid.in_view > 0; });
    if (survey.view.in_water > 0 && survey.view.on_surface == 0 && !grid_in_view)
        warnings.emplace_back(
            "neither a surface nor a volume is in view: the image shows water alone");
}

constexpr int k_points = 32;                // along each side of a grid's bounds
constexpr int k_columns = 48, k_rows = 27;  // rays over the image
constexpr double k_infinity = std::numeric_limits<double>::infinity();

/// Optical depths between points, and whether lamps light points.
class Reach {
  public:
    explicit Reach(const AssembledScene& scene) : scene_(scene), attenuation_(scene.water.medium) {}

    std::vector<double> depth(const Point3& from, const Point3& to) const {
        std::vector<double> columns(static_cast<std::size_t>(scene_.field->constituent_count()));
        scene_.field->column(from, to, columns);
        std::vector<double> depth;
        depth.reserve(static_cast<std::size_t>(attenuation_.band_count));
        for (int band = 0; band < attenuation_.band_count; ++band)
            depth.push_back(attenuation_.optical_depth(band, distance(from, to), columns));
        return depth;
    }
    /// Whether some lamp's light arrives at `x` (k_reach); with a normal, from its side of the
    /// surface.
    bool any(const Point3& x, const Vector3* normal) const {
        return std::ranges::any_of(scene_.emitters,
                                   [&](const Lamp& lamp) { return reaches(lamp, x, normal); });
    }

  private:
    bool reaches(const Lamp& lamp, const Point3& x, const Vector3* normal) const {
        const Point3 origin = lamp.origin(x);
        const Vector3 way = x - origin;
        if (normal != nullptr && glm::dot(way, *normal) >= 0) return false;
        const double irradiance = lamp.relative_intensity(way) / lamp.spread(glm::length(way));
        if (!(irradiance >= k_reach) || scene_.surfaces->occluded(origin, x)) return false;
        const std::vector<double> tau = depth(origin, x);
        for (std::size_t band = 0; band < tau.size(); ++band)
            if (lamp.axis_intensity()[band] > 0 && irradiance * std::exp(-tau[band]) >= k_reach)
                return true;
        return false;
    }

    const AssembledScene& scene_;
    AttenuationTable attenuation_;
};

/// How the camera sees a point.
struct PointView {
    bool is_seen = false;
    std::uint32_t hidden_by = 0;  // in the image, but behind this object, from 1; 0: none
};

PointView view_of_point(const AssembledScene& scene, const Point3& x) {
    const auto pixel = scene.camera->project(x);
    if (!pixel || pixel->x < 0 || pixel->y < 0 || pixel->x > scene.camera->width() ||
        pixel->y > scene.camera->height())
        return {};
    const auto ray = scene.camera->refracted_ray(pixel->x, pixel->y);
    if (!ray) return {};
    if (!scene.surfaces->occluded(ray->origin, x)) return {.is_seen = true};
    SurfaceHit hit;
    const Ray to_point{ray->origin, glm::normalize(x - ray->origin)};
    if (!scene.surfaces->closest_hit(to_point, distance(ray->origin, x), hit)) return {};
    return {.hidden_by = hit.object_id};
}

/// An object as messages name it.
std::string name_of_object(const Surfaces& surfaces, std::uint32_t id) {
    const SurfaceName& object = surfaces.names().objects.at(id - 1);
    if (!object.entry) return object.name;
    const std::string entry = fmt::format("geometry[{}]", *object.entry);
    return object.name.empty() ? entry : fmt::format("'{}' ({})", printable(object.name), entry);
}

/// Fills in the fractions: sums over points distributed evenly in the grid's bounds.
void measure_fractions(const AssembledScene& scene, const Reach& reach, const GridVolume& grid,
                       GridSurvey& survey) {
    const Bounds& box = grid.voxel_bounds();
    if (box.empty()) return;
    struct Sums {
        double all = 0, in_view = 0, in_reach = 0, in_both = 0;
        std::map<std::uint32_t, double> hidden{};  // by object
    };
    std::vector<Sums> parts(k_points);
    parallel_for(parts.size(), [&](std::size_t slice) {
        Sums& sums = parts[slice];
        const auto at = [&](int axis, double n) {
            return box.min[axis] + (n + 0.5) / k_points * (box.max[axis] - box.min[axis]);
        };
        for (int j = 0; j < k_points; ++j)
            for (int k = 0; k < k_points; ++k) {
                const Point3 x{at(0, static_cast<double>(slice)), at(1, j), at(2, k)};
                const double value = grid.value(x);
                if (value == 0) continue;
                const PointView view = view_of_point(scene, x);
                const bool seen = view.is_seen, reached = reach.any(x, nullptr);
                sums.all += value;
                if (seen) sums.in_view += value;
                if (reached) sums.in_reach += value;
                if (seen && reached) sums.in_both += value;
                if (view.hidden_by != 0) sums.hidden[view.hidden_by] += value;
            }
    });
    Sums total;
    for (const Sums& part : parts) {
        total.all += part.all;
        total.in_view += part.in_view;
        total.in_reach += part.in_reach;
        total.in_both += part.in_both;
        for (const auto& [object, value] : part.hidden) total.hidden[object] += value;
    }
    if (total.all == 0) return;
    survey.in_view = total.in_view / total.all;
    survey.in_reach = total.in_reach / total.all;
    survey.in_both = total.in_both / total.all;
    if (total.hidden.empty()) return;
    const auto [object, most] =
        *std::ranges::max_element(total.hidden, {}, [](const auto& entry) { return entry.second; });
    survey.hidden = most / total.all;
    survey.hidden_behind = name_of_object(*scene.surfaces, object);
}

std::vector<GridSurvey> survey_grids(const AssembledScene& scene, const Reach& reach) {
    std::vector<GridSurvey> grids;
    for (const LoadedVolume& volume : scene.volumes)
        for (std::size_t g = 0; g < volume.grids.size(); ++g) {
            GridSurvey survey;
            survey.report = volume.reports[g];
            for (std::size_t axis = 0; axis < 3; ++axis)
                survey.depth[axis] = depth_through_middle(survey.report, scene.water.medium, axis);
            measure_fractions(scene, reach, volume.grids[g], survey);
            grids.push_back(std::move(survey));
        }
    return grids;
}

CentralRaySurvey survey_central_ray(const AssembledScene& scene) {
    CentralRaySurvey survey;
    const CameraDesc& camera = scene.desc().camera;
    const auto ray = scene.camera->refracted_ray(0.5 * camera.width, 0.5 * camera.height);
    if (!ray) return survey;
    survey.enters = true;
    survey.surface_distance = scene.surfaces->hit_distance(*ray);
    const Medium& medium = scene.water.medium;
    const AttenuationTable attenuation(medium);
    const ConcentrationField& grids = scene.field->grids();
    const Bounds bounds = grids.bounds();
    double end = survey.surface_distance;
    if (!bounds.empty())
        end = std::min(end, distance(ray->origin, bounds.center()) + bounds.diagonal());
    std::vector<double> columns(static_cast<std::size_t>(medium.constituent_count()));
    if (std::isfinite(end)) grids.column(ray->origin, ray->at(end), columns);
    std::vector<double> of_depth(columns.size());
    if (scene.water.strata && std::isfinite(survey.surface_distance))
        scene.water.strata->add_column(ray->origin, ray->at(survey.surface_distance), of_depth);
    for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band) {
        survey.water.push_back(attenuation.optical_depth(band, survey.surface_distance, of_depth));
        survey.volumes.push_back(attenuation.optical_depth(band, 0, columns));
    }
    return survey;
}

ViewSurvey survey_view(const AssembledScene& scene, const Reach& reach) {
    ViewSurvey view;
    view.nearest = k_infinity;
    double rays = 0, hits = 0, lit = 0, hidden = 0;
    for (int j = 0; j < k_rows; ++j)
        for (int i = 0; i < k_columns; ++i) {
            const auto ray =
                scene.camera->refracted_ray((i + 0.5) / k_columns * scene.desc().camera.width,
                                            (j + 0.5) / k_rows * scene.desc().camera.height);
            if (!ray) continue;
            ++rays;
            SurfaceHit hit;
            if (!scene.surfaces->closest_hit(*ray, k_infinity, hit)) continue;
            ++hits;
            view.nearest = std::min(view.nearest, hit.distance);
            view.farthest = std::max(view.farthest, hit.distance);
            if (reach.any(hit.position, &hit.geometric_normal)) ++lit;
            if (std::ranges::min(reach.depth(ray->origin, hit.position)) > k_opaque_depth) ++hidden;
        }
    view.in_water = rays / (k_columns * k_rows);
    if (hits == 0) {
        view.nearest = 0;
        return view;
    }
    view.on_surface = hits / (k_columns * k_rows);
    view.lit = lit / hits;
    view.hidden = hidden / hits;
    return view;
}

double degrees_between(const std::optional<Ray>& a, const std::optional<Ray>& b) {
    if (!a || !b) return std::numeric_limits<double>::quiet_NaN();
    const double sine = glm::length(glm::cross(a->direction, b->direction));
    return std::atan2(sine, glm::dot(a->direction, b->direction)) * 180 / std::numbers::pi;
}

}  // namespace

SceneSurvey survey_scene(const AssembledScene& scene,
                         const std::optional<DraftContrast>& contrast) {
    SceneSurvey survey(scene);
    survey.contrast = contrast;
    const Reach reach(scene);
    survey.grids = survey_grids(scene, reach);
    survey.central_ray = survey_central_ray(scene);
    survey.view = survey_view(scene, reach);
    const double width = scene.desc().camera.width, height = scene.desc().camera.height;
    const auto ray = [&](double x, double y) { return scene.camera->refracted_ray(x, y); };
    survey.field_of_view = {degrees_between(ray(0, height / 2), ray(width, height / 2)),
                            degrees_between(ray(width / 2, 0), ray(width / 2, height))};
    const std::vector<double>& bands_nm = scene.desc().water.bands_nm;
    survey.lateral_colour = band_shifts(scene.desc().camera, bands_nm);
    survey.colour_groups = colour_groups_of(scene.desc()).size();
    survey.warnings = scene.warnings;
    append_survey_warnings(survey);
    if (const auto warning = far_lamp_warning(scene)) survey.warnings.push_back(*warning);
    survey.left_out = estimate_light_left_out(scene);
    if (const auto warning = left_out_note(scene, survey.left_out))
        survey.warnings.push_back(*warning);
    for (std::string& note : pointed_lamp_notes(scene, find_pointed_lamps(scene)))
        survey.warnings.push_back(std::move(note));
    return survey;
}

}  // namespace uw
