#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/report.h"
#include "core/base/vector_math.h"
#include "core/geometry/surfaces.h"
#include "core/scene/scene_desc.h"
#include "render/image_scene.h"

namespace uw {

/// The camera in one frame.
struct PathPoint {
    int frame = 0;
    double time = 0;  // [s]
    Point3 position;
    double height = 0;  // above the surface right below [m]; infinite: there is none
};

/// The path of the camera (of a rig, the first one) through a scene.
struct PathSurvey {
    FrameRange frames;
    std::vector<PathPoint> points;  // of all frames, or of 2000 evenly spaced ones
    bool is_y_up = true;            // else -y is up, by the camera's orientation
    double length = 0;              // [m]
    double top_speed = 0;           // between successive points [m/s]
    /// The first point without a surface below it, after one that has one.
    std::optional<std::size_t> leaves_floor;
    /// The first point that a surface hides from the one before, and the surface's name.
    std::optional<std::size_t> enters;
    std::string entered;
};

/// Follows the camera of `scene`, as read; `surfaces` are those of one of its frames. None if
/// nothing moves, or there is no frame in which everything that moves has a pose.
std::optional<PathSurvey> survey_path(const SceneDesc& scene, const Surfaces& surfaces);

/// Its length and speed, its heights, and where it leaves the floor or enters a surface.
Report report_on_path(const PathSurvey& path);

/// A map of the camera's path over the outlines of the surfaces as seen from above, and its height
/// over what is below, as an SVG document. `title`: the scene's name.
std::string path_plot(const PathSurvey& path, const Surfaces& surfaces, const std::string& title);

}  // namespace uw
