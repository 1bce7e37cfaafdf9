#include "cli/info/path_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "render/resolved_scene.h"

namespace uw {

namespace {

constexpr int k_most_points = 2000;

Affine world_from_camera(const SceneDesc& scene, int frame) {
    SceneDesc at = scene_of_image(scene, {frame});
    if (at.camera.has_pose) return at.camera.world_from_camera;
    return ResolvedScene(std::move(at)).desc().camera.world_from_camera;  // a glTF file's
}

/// The surface between two points, by its name; empty: there is none.
std::string surface_between(const Point3& from, const Point3& to, const Surfaces& surfaces) {
    const double way = distance(from, to);
    SurfaceHit hit;
    if (!(way > 0) || !surfaces.closest_hit({from, (to - from) / way}, way, hit)) return {};
    return surfaces.names().objects.at(hit.object_id - 1).name;
}

std::string frame_text(const PathPoint& point) {
    return fmt::format("frame {} ({:.4g} s)", point.frame, point.time);
}

}  // namespace

std::optional<PathSurvey> survey_path(const SceneDesc& scene, const Surfaces& surfaces) {
    if (!has_motion(scene)) return std::nullopt;
    const std::optional<FrameRange> frames = frames_of(scene);
    if (!frames) return std::nullopt;
    PathSurvey path;
    path.frames = *frames;
    const int steps = std::min(frames->last - frames->first, k_most_points - 1);
    double up = 0;
    for (int i = 0; i <= steps; ++i) {
        const double share = steps == 0 ? 0 : static_cast<double>(i) / steps;
        PathPoint point;
        point.frame =
            frames->first + static_cast<int>(std::lround(share * (frames->last - frames->first)));
        point.time = time_of_frame(scene, point.frame);
        const Affine pose = world_from_camera(scene, point.frame);
        point.position = at_origin_plus(pose.offset());
        up -= pose.linear()[1].y;
        path.points.push_back(point);
    }
    path.is_y_up = up >= 0;
    const Vector3 down(0, path.is_y_up ? -1 : 1, 0);
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        PathPoint& point = path.points[i];
        point.height = surfaces.hit_distance({point.position, down});
        if (i == 0) continue;
        const PathPoint& before = path.points[i - 1];
        const double way = distance(before.position, point.position);
        path.length += way;
        path.top_speed = std::max(path.top_speed, way / (point.time - before.time));
        if (!path.leaves_floor && std::isfinite(before.height) && !std::isfinite(point.height))
            path.leaves_floor = i;
        if (path.enters) continue;
        path.entered = surface_between(before.position, point.position, surfaces);
        if (!path.entered.empty()) path.enters = i;
    }
    return path;
}

std::string path_text(const PathSurvey& path) {
    const PathPoint& first = path.points.front();
    const PathPoint& last = path.points.back();
    std::string text = fmt::format(
        "path of the camera\n  frames {}-{}, {:.4g} to {:.4g} s: {:.4g} m, at most {:.3g} m/s\n",
        path.frames.first, path.frames.last, first.time, last.time, path.length, path.top_speed);
    const auto by_height = std::ranges::minmax_element(path.points, {}, &PathPoint::height);
    if (std::isfinite(by_height.min->height))
        text += fmt::format(
            "  {:.4g}{} m above the surface below, lowest in {}\n", by_height.min->height,
            std::isfinite(by_height.max->height) ? fmt::format(" to {:.4g}", by_height.max->height)
                                                 : " or more",
            frame_text(*by_height.min));
    else
        text += "  no surface is below it\n";
    if (path.leaves_floor)
        text += fmt::format("  it leaves the floor: no surface is below it in {}\n",
                            frame_text(path.points[*path.leaves_floor]));
    if (path.enters)
        text += fmt::format("  it enters a surface: '{}', by {}\n", printable(path.entered),
                            frame_text(path.points[*path.enters]));
    return text;
}

}  // namespace uw
