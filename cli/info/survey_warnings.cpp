#include "cli/info/survey_warnings.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/text.h"

namespace uw {

namespace {

constexpr double k_invisible_depth = 0.01;

void warn_of_grid(const GridSurvey& grid, bool has_lamps, std::vector<std::string>& warnings) {
    const std::string name = fmt::format("grid '{}' of '{}': ", grid.report.grid,
                                         printable(grid.report.file.filename().string(), 300));
    const auto warn = [&](const std::string& what) { warnings.push_back(name + what); };
    if (grid.report.bounds.empty()) return;  // loading has warned of it
    if (grid.in_view == 0)
        warn(
            "nothing of it is in view of the camera; compare its world bounds with camera.pose, "
            "and give it a transform");
    if (has_lamps && grid.in_reach == 0)
        warn("no lamp reaches any of it: it will be black; move a lamp nearer, or aim it there");
    else if (has_lamps && grid.in_view > 0 && grid.in_both == 0)
        warn("no lamp reaches what is in view of it: it will be black");
    double most = 0, least = 1e300;
    for (const std::vector<double>& depth : grid.depth) {
        most = std::max(most, std::ranges::max(depth));
        least = std::min(least, std::ranges::min(depth));
    }
    if (most < k_invisible_depth)
        warn(
            fmt::format("its optical depth is {:.2g} at most: it will be invisible; raise the ppm "
                        "per unit, or check transform.scale",
                        most));
    if (least > k_opaque_depth)
        warn(
            fmt::format("its optical depth is {:.3g} or more along every axis: it is opaque; lower "
                        "the ppm per unit, or check transform.scale",
                        least));
}

void warn_of_surfaces(const SceneSurvey& survey, std::vector<std::string>& warnings) {
    const ViewSurvey& view = survey.view;
    if (view.on_surface == 0) return;
    if (!survey.scene.lamps.empty() && view.lit == 0)
        warnings.emplace_back(
            "no lamp reaches any surface in view: they will be black; move a lamp nearer, or aim "
            "it there");
    if (view.hidden == 1)
        warnings.push_back(fmt::format(
            "every surface in view lies behind an optical depth over {:g} in all bands: none will "
            "be seen; go nearer, or make the water or the volumes clearer",
            k_opaque_depth));
    else if (view.hidden > 0.5)
        warnings.push_back(fmt::format(
            "{:.0f} % of the surfaces in view lie behind an optical depth over {:g} in all bands",
            100 * view.hidden, k_opaque_depth));
}

/// What makes volumes in view hard to see, and the mend.
void warn_of_contrast(const SceneSurvey& survey, std::vector<std::string>& warnings) {
    if (!survey.contrast || survey.contrast->seen == 0) return;
    const DraftContrast& draft = *survey.contrast;
    if (draft.contrast >= k_hardly_seen) return;
    constexpr double k_thin = 0.5;
    warnings.push_back(fmt::format(
        "the volumes change the picture by {:.2g} % where they are seen (99th percentile): they "
        "will hardly be noticed; {}",
        100 * draft.contrast,
        draft.depth < k_thin
            ? fmt::format("their optical depth there is {:.2g}: raise the ppm per unit, or check "
                          "transform.scale",
                          draft.depth)
            : "move the lamps away from the camera and nearer to the volumes, so that less water "
              "is lit before them, go nearer with the camera, or make the water clearer"));
}

}  // namespace

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

}  // namespace uw
