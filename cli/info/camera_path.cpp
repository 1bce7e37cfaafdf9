#include "cli/info/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cli/pages/svg_plot.h"
#include "core/base/text.h"
#include "render/image_scene.h"

namespace uw {

namespace {

constexpr int k_max_points = 2000;

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
    const int steps = std::min(frames->last - frames->first, k_max_points - 1);
    double up = 0;
    for (int i = 0; i <= steps; ++i) {
        const double fraction = steps == 0 ? 0 : static_cast<double>(i) / steps;
        PathPoint point;
        point.frame = frames->first +
                      static_cast<int>(std::lround(fraction * (frames->last - frames->first)));
        point.time = time_of_frame(scene, point.frame);
        const Affine pose = world_from_camera(scene, {point.frame});
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

Report report_on_path(const PathSurvey& path) {
    const PathPoint& first = path.points.front();
    const PathPoint& last = path.points.back();
    const auto frame = [&](const std::optional<std::size_t>& index) {
        return index ? Json(path.points[*index].frame) : Json(nullptr);
    };
    Report report("path of the camera");
    report.say(fmt::format("frames {}-{}, {:.4g} to {:.4g} s: {:.4g} m, at most {:.3g} m/s",
                           path.frames.first, path.frames.last, first.time, last.time, path.length,
                           path.top_speed));
    report.set({{"first_frame", path.frames.first},
                {"last_frame", path.frames.last},
                {"length", path.length},
                {"top_speed", path.top_speed}});
    const auto [lowest, highest] = std::ranges::minmax_element(path.points, {}, &PathPoint::height);
    report.say(std::isfinite(lowest->height)
                   ? fmt::format("{:.4g}{} m above the surface below, lowest in {}", lowest->height,
                                 std::isfinite(highest->height)
                                     ? fmt::format(" to {:.4g}", highest->height)
                                     : " or more",
                                 frame_text(*lowest))
                   : "no surface is below it");
    if (path.leaves_floor)
        report.say(fmt::format("it leaves the floor: no surface is below it in {}",
                               frame_text(path.points[*path.leaves_floor])));
    if (path.enters)
        report.say(fmt::format("it enters a surface: '{}', by {}", printable(path.entered),
                               frame_text(path.points[*path.enters])));
    report.set({{"leaves_floor", frame(path.leaves_floor)},
                {"enters", frame(path.enters)},
                {"entered", path.entered}});
    Json points = Json::array();
    for (const PathPoint& point : path.points)
        points.push_back({{"frame", point.frame},
                          {"time", point.time},
                          {"position", point_json(point.position)},
                          {"height", number_json(point.height)}});
    report.set({{"points", std::move(points)}});
    return report;
}

namespace {

constexpr double k_unbounded = std::numeric_limits<double>::infinity();
constexpr double k_gap = std::numeric_limits<double>::quiet_NaN();  // breaks a line
// Cells of the map, whose panel is about as much wider than high.
constexpr int k_map_columns = 300, k_map_rows = 180;

/// The part of the world that the map shows, in x and -z: the path and the surfaces around it.
struct MapFrame {
    double x = 0, y = 0;  // of its lower left corner
    double width = 1, height = 1;

    MapFrame(const PathSurvey& path, const Bounds& surfaces) {
        Bounds shown;
        for (const PathPoint& point : path.points) shown.extend(point.position);
        const double around = std::max(1.0, shown.diagonal());
        if (!surfaces.empty()) {
            // As much of the surfaces as is near.
            Bounds near = shown;
            for (int axis = 0; axis < 3; ++axis) {
                near.min[axis] =
                    std::clamp(surfaces.min[axis], shown.min[axis] - around, shown.min[axis]);
                near.max[axis] =
                    std::clamp(surfaces.max[axis], shown.max[axis], shown.max[axis] + around);
            }
            shown = near;
        }
        const double cell =
            1.1 * std::max({(shown.max.x - shown.min.x) / k_map_columns,
                            (shown.max.z - shown.min.z) / k_map_rows, 1.0 / k_map_rows});
        width = cell * k_map_columns;
        height = cell * k_map_rows;
        x = 0.5 * (shown.min.x + shown.max.x - width);
        y = 0.5 * (-shown.min.z - shown.max.z - height);
    }
    double column(int i) const { return x + width * i / k_map_columns; }
    double row(int j) const { return y + height * j / k_map_rows; }
};

/// The object that is visible from above in every cell; 0: none.
std::vector<std::uint32_t> objects_from_above(const MapFrame& map, const PathSurvey& path,
                                              const Surfaces& surfaces) {
    std::vector<std::uint32_t> objects(k_map_columns * k_map_rows, 0);
    const double up = path.is_y_up ? 1 : -1;
    double top = -k_unbounded;
    for (const PathPoint& point : path.points) top = std::max(top, up * point.position.y);
    const Bounds bounds = surfaces.bounds();
    if (!bounds.empty()) top = std::max({top, up * bounds.min.y, up * bounds.max.y});
    for (int j = 0; j < k_map_rows; ++j)
        for (int i = 0; i < k_map_columns; ++i) {
            const Point3 above{map.column(i) + 0.5 * map.width / k_map_columns, up * (top + 1),
                               -map.row(j) - 0.5 * map.height / k_map_rows};
            SurfaceHit hit;
            if (surfaces.closest_hit({above, {0, -up, 0}}, k_unbounded, hit))
                objects[static_cast<std::size_t>(j * k_map_columns + i)] = hit.object_id;
        }
    return objects;
}

/// The borders between the objects that are visible from above.
PlotCurve outlines(const MapFrame& map, const PathSurvey& path, const Surfaces& surfaces) {
    const std::vector<std::uint32_t> objects = objects_from_above(map, path, surfaces);
    const auto object = [&](int i, int j) {
        return objects[static_cast<std::size_t>(j * k_map_columns + i)];
    };
    PlotCurve curve;
    curve.label = "surfaces from above";
    curve.colour = "#888888";
    curve.width = 1;
    const auto draw = [&](double x0, double y0, double x1, double y1) {
        curve.x.insert(curve.x.end(), {x0, x1, k_gap});
        curve.y.insert(curve.y.end(), {y0, y1, k_gap});
    };
    for (int j = 0; j < k_map_rows; ++j)
        for (int i = 0; i < k_map_columns; ++i) {
            if (i > 0 && object(i, j) != object(i - 1, j))
                draw(map.column(i), map.row(j), map.column(i), map.row(j + 1));
            if (j > 0 && object(i, j) != object(i, j - 1))
                draw(map.column(i), map.row(j), map.column(i + 1), map.row(j));
        }
    return curve;
}

PlotCurve path_curve(const char* label) {
    PlotCurve curve;
    curve.label = label;
    curve.colour = plot_colour::k_blue;
    return curve;
}

/// A dot at one point, if there is one.
void add_mark(PlotPanel& panel, const char* label, const char* colour, double x, double y) {
    PlotCurve mark;
    mark.label = label;
    mark.colour = colour;
    mark.width = 0;
    mark.markers = true;
    mark.x = {x};
    mark.y = {y};
    panel.curves.push_back(std::move(mark));
}

PlotPanel map_panel(const PathSurvey& path, const Surfaces& surfaces) {
    const MapFrame map(path, surfaces.bounds());
    PlotPanel panel;
    panel.title = "From above";
    panel.x = {"x [m]", {AxisScale::linear, map.x, map.x + map.width, {}}};
    panel.y = {"-z [m]", {AxisScale::linear, map.y, map.y + map.height, {}}};
    panel.curves.push_back(outlines(map, path, surfaces));
    panel.curves.push_back(path_curve("camera"));
    for (const PathPoint& point : path.points) {
        panel.curves.back().x.push_back(point.position.x);
        panel.curves.back().y.push_back(-point.position.z);
    }
    const auto mark = [&](const char* label, const char* colour, std::size_t index) {
        add_mark(panel, label, colour, path.points[index].position.x,
                 -path.points[index].position.z);
    };
    mark("first frame", plot_colour::k_green, 0);
    if (path.leaves_floor) mark("leaves the floor", plot_colour::k_orange, *path.leaves_floor);
    if (path.enters) mark("enters a surface", plot_colour::k_red, *path.enters);
    return panel;
}

PlotPanel height_panel(const PathSurvey& path) {
    PlotPanel panel;
    panel.title = "Height";
    panel.x = {"time [s]", {}};
    panel.y = {path.is_y_up ? "y [m]" : "-y [m]", {}};
    PlotCurve floor;
    floor.label = "surface below";
    floor.colour = "#888888";
    panel.curves = {floor, path_curve("camera")};
    for (const PathPoint& point : path.points) {
        const double y = path.is_y_up ? point.position.y : -point.position.y;
        for (PlotCurve& curve : panel.curves) curve.x.push_back(point.time);
        panel.curves[0].y.push_back(y - point.height);
        panel.curves[1].y.push_back(y);
    }
    return panel;
}

}  // namespace

std::string path_plot(const PathSurvey& path, const Surfaces& surfaces, const std::string& title) {
    PlotFigure figure;
    figure.title = title;
    figure.panels = {map_panel(path, surfaces), height_panel(path)};
    return svg_document(figure);
}

}  // namespace uw
