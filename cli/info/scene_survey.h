#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "camera/lateral_colour.h"
#include "cli/info/camera_path.h"
#include "cli/info/plume_view.h"
#include "cli/info/vdb_report.h"
#include "core/scene/variations.h"
#include "render/light_left_out.h"
#include "render/scene_assembly.h"

namespace uw {

/// A point is lit by a lamp if it lies in its beam, no surface is between, and in some band the
/// irradiance exceeds this fraction of that on the axis at 1 m without water: profile e^-tau / r^2.
inline constexpr double k_reach = 1e-3;

/// One grid of the scene. Fractions are of the sum of its values.
struct GridSurvey {
    VolumeReport report;
    std::array<std::vector<double>, 3> depth;  // through its centre along world x, y, z, per band
    double in_view = 0;                        // within the image and behind no surface
    double in_reach = 0;                       // of at least one lamp
    double in_both = 0;
    double hidden = 0;          // within the image, but behind the object that hides most of it
    std::string hidden_behind;  // that object, "'hull' (geometry[0])"; empty: nothing hides any
};

/// The ray of the image centre, from where it enters the water.
struct CentralRaySurvey {
    bool enters = false;
    double surface_distance = 0;  // infinite: no surface ends it [m]
    std::vector<double> water;    // optical depth of the uniform water up to the surface, per band
    std::vector<double> volumes;  // and of the grids
};

/// Rays over the whole image.
struct ViewSurvey {
    double in_water = 0;               // fraction of the image whose rays enter the water
    double on_surface = 0;             // and meet a surface
    double lit = 0;                    // fraction of those surfaces that a lamp reaches
    double hidden = 0;                 // and of those behind an optical depth over 10 in all bands
    double nearest = 0, farthest = 0;  // surface [m]
};

/// The values that a scene's variations draw.
struct VariationsSurvey {
    VariationsDesc desc;
    std::vector<std::vector<DrawnValue>> first;  // the values of the first few
};

/// What `uwvdb info` reports about a scene without rendering it.
struct SceneSurvey {
    explicit SceneSurvey(const AssembledScene& of) : scene(of) {}

    const AssembledScene& scene;
    std::vector<SequenceReport> sequences;
    std::vector<GridSurvey> grids;
    CentralRaySurvey central_ray;
    ViewSurvey view;
    std::optional<DraftContrast> contrast;  // of the volumes; none without volumes or lamps
    std::array<double, 2> field_of_view{};  // in the water, through the centre [degrees]
    std::vector<BandShift> lateral_colour;  // empty: no index depends on the wavelength
    std::size_t colour_groups = 1;
    std::optional<LightLeftOut> left_out;  // by single scattering; none: it renders all light
    std::optional<PathSurvey> path;        // of the camera; none: nothing moves
    std::optional<VariationsSurvey> variations;
    std::vector<std::string> files_outside;  // read by the scene, but not in its folder
    std::vector<std::string> warnings;       // the scene's, then what will be black or opaque
};

/// Surveys an assembled scene, which outlives the result. `contrast`: from drafts of it, if any
/// were rendered. Deterministic.
SceneSurvey survey_scene(const AssembledScene& scene, const std::optional<DraftContrast>& contrast);

}  // namespace uw
