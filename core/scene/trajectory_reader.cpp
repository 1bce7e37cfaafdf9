#include "core/scene/trajectory_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "core/scene/config_value.h"
#include "core/scene/pose_file.h"
#include "core/scene/scene_context.h"

namespace uw {

namespace {

constexpr double k_rigid_tolerance = 1e-6;
constexpr double k_min_scale = 1e-9;

/// Closer to the view direction than this angle [rad], `up` leaves the roll undefined.
constexpr double k_min_up_angle = 1e-6;

Affine read_rotate(const ConfigValue& value) {
    return Affine::rotation_xyz_degrees(
        value.vector("give three angles in degrees, about x, then y, then z"));
}

Affine read_look_at(ConfigMap& map, const Point3& position) {
    const Vector3 default_up(0, 1, 0);
    const ConfigValue target_value = map.require(
        "look_at", "give a point the camera looks at, rotate, or the pose as a 4x4 matrix");
    const Point3 target =
        at_origin_plus(target_value.vector("give a point the camera looks at, in metres"));
    const auto up_value = map.find("up");
    const Vector3 up = up_value
                           ? up_value->direction("give the world direction that is up in the image")
                           : default_up;

    const Vector3 to_target = target - position;
    const double distance_to_target = glm::length(to_target);
    if (!(distance_to_target > 1e-12) || !std::isfinite(distance_to_target)) {
        target_value.fail("is the camera's own position; give another point, along the view");
    }
    const Vector3 forward = to_target / distance_to_target;
    const Vector3 side = glm::cross(forward, up);
    if (glm::length(side) < k_min_up_angle) {
        const ConfigValue& at = up_value ? *up_value : target_value;
        at.fail(fmt::format("up [{}, {}, {}] is parallel to the view direction; give another 'up'",
                            up.x, up.y, up.z));
    }
    const Vector3 right = glm::normalize(side);
    return {Matrix3(right, glm::cross(forward, right), forward), from_origin(position)};
}

Affine read_matrix(const ConfigValue& value) {
    constexpr auto k_hint = "give world_from_camera as four rows of four numbers";
    double rows[4][4] = {};
    const std::vector<ConfigValue> row_values = value.list_of(4, k_hint);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::vector<ConfigValue> numbers = row_values[i].list_of(4, k_hint);
        for (std::size_t j = 0; j < 4; ++j) rows[i][j] = numbers[j].number(k_hint);
    }
    for (std::size_t j = 0; j < 4; ++j) {
        if (std::abs(rows[3][j] - (j == 3 ? 1.0 : 0.0)) > k_rigid_tolerance) {
            row_values[3].fail(
                "the last row must be [0, 0, 0, 1]; give the rows of the matrix, not "
                "its columns");
        }
    }
    Matrix3 linear(0.0);
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) linear[j][i] = rows[i][j];
    }
    const Matrix3 product = glm::transpose(linear) * linear;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            // written so that a NaN from overflowing products fails too
            if (!(std::abs(product[i][j] - (i == j ? 1.0 : 0.0)) <= k_rigid_tolerance)) {
                value.fail(
                    "is not rigid: its 3x3 part is not a rotation to within 1e-6; remove scale and "
                    "shear, and give more digits");
            }
        }
    }
    if (glm::determinant(linear) < 0) {
        value.fail(
            "mirrors the world (determinant -1); camera axes are x right, y down, z forward");
    }
    return {linear, Vector3(rows[0][3], rows[1][3], rows[2][3])};
}

/// The same from the keys `position`, `look_at` and `up`, `rotate`, or `matrix` of `map`, of which
/// all others must have been read. `is_view`: one of look_at, rotate and matrix is required; else
/// the axes are those of the world without them.
Affine read_pose_keys(ConfigMap& map, bool is_view) {
    if (const auto matrix = map.find("matrix")) {
        map.finish("a pose with 'matrix'");
        return read_matrix(*matrix);
    }
    Point3 position;
    if (const auto value = map.find("position"))
        position = at_origin_plus(value->vector("give the position in metres"));
    const auto rotate = map.find("rotate");
    if (rotate || (!is_view && !map.has("look_at"))) {
        map.finish("a pose without 'look_at', or with 'rotate',");
        const Affine moved = Affine::translation(from_origin(position));
        return rotate ? moved * read_rotate(*rotate) : moved;
    }
    return read_look_at(map, position);
}

}  // namespace

Affine read_pose(const ConfigValue& value) {
    ConfigMap map(value, {"position", "look_at", "up", "rotate", "matrix"},
                  "write {position: [0, 0, 0], look_at: [0, 0, 1]}");
    return read_pose_keys(map, true);
}

Affine read_placed_pose(const ConfigValue& value) {
    ConfigMap map(value, {"position", "look_at", "up", "rotate", "matrix"},
                  "write {position: [0, 0, 0], rotate: [0, 0, 0]}");
    return read_pose_keys(map, false);
}

Affine read_transform(const ConfigValue& value) {
    ConfigMap map(value, {"scale", "rotate", "translate"},
                  "write {scale: 1, rotate: [0, 0, 0], translate: [0, 0, 0]}");
    Vector3 scale(1.0);
    if (const auto entry = map.find("scale")) {
        constexpr auto k_hint = "give one factor, or one per axis, none of them 0";
        scale = entry->node().kind == ConfigNode::Kind::sequence ? entry->vector(k_hint)
                                                                 : Vector3(entry->number(k_hint));
        // smaller factors would make the map's determinant vanish
        if (glm::any(glm::lessThan(glm::abs(scale), Vector3(k_min_scale)))) {
            entry->fail("must not be 0 or closer to 0 than 1e-9; give one factor, or one per axis");
        }
    }
    Affine rotation;
    if (const auto entry = map.find("rotate")) rotation = read_rotate(*entry);
    Vector3 offset(0.0);
    if (const auto entry = map.find("translate")) {
        offset = entry->vector("give three lengths in metres");
    }
    return Affine::translation(offset) * rotation * Affine::scale(scale);
}

namespace {

constexpr auto k_formats = std::to_array<std::pair<std::string_view, PoseFormat>>(
    {{"tum", PoseFormat::tum},
     {"euroc", PoseFormat::euroc},
     {"colmap", PoseFormat::colmap},
     {"nerfstudio", PoseFormat::nerfstudio}});

PoseFormat format_of(const ConfigValue& file, const std::filesystem::path& name) {
    const std::optional<PoseFormat> format = pose_format_called(name);
    if (!format)
        file.fail(
            "its name does not say how it is written; add format: tum, euroc, colmap or "
            "nerfstudio");
    return *format;
}

/// Where a file's world is: a transform whose scale is one factor above 0.
void read_placement(const ConfigValue& value, TrajectoryDesc& trajectory) {
    const Affine transform = read_transform(value);
    const double scale = std::cbrt(transform.determinant());
    const Matrix3 linear = transform.linear() / scale;
    const Matrix3 product = glm::transpose(linear) * linear;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!(std::abs(product[i][j] - (i == j ? 1.0 : 0.0)) <= 1e-9) || scale < 0)
                value.fail("the scale of a trajectory must be one factor above 0");
    trajectory.scale = scale;
    trajectory.world_from_file = {linear, transform.offset()};
}

void read_file(ConfigMap& map, const ConfigValue& file, const SceneContext& context,
               TrajectoryDesc& trajectory) {
    trajectory.file = read_existing_file(file, context);
    const auto format = map.find("format");
    trajectory.format = format ? format->choice(k_formats) : format_of(file, trajectory.file);
    if (const auto start = map.find("start")) {
        if (trajectory.format == PoseFormat::colmap || trajectory.format == PoseFormat::nerfstudio)
            start->fail("files of this format have no times: their poses are those of the frames");
        trajectory.start =
            start->number("give the file's time that is the scene's time 0, in seconds");
    }
    if (const auto transform = map.find("transform")) read_placement(*transform, trajectory);
    map.finish("a trajectory from a file");
}

void read_pace(const ConfigValue& value, Pacing& pacing) {
    if (value.node().kind == ConfigNode::Kind::scalar && value.node().scalar == "constant") {
        pacing.kind = Pacing::Kind::constant;
        return;
    }
    pacing.kind = Pacing::Kind::speed;
    pacing.speed = value.positive("write constant, or give the speed in m/s");
}

/// The time of keyframe `index` of `count`, as far as the pacing leaves it to be given.
double read_time(ConfigMap& map, const Pacing& pacing, std::size_t index, std::size_t count) {
    const bool is_first = index == 0, is_last = index + 1 == count;
    const auto time = map.find("time");
    const bool has_time = pacing.kind == Pacing::Kind::given || is_first ||
                          (is_last && pacing.kind == Pacing::Kind::constant);
    if (!has_time) {
        if (time)
            time->fail(fmt::format(
                "follows from 'speed'; give the time of the first {} only",
                pacing.kind == Pacing::Kind::speed ? "keyframe" : "and the last keyframe"));
        return 0;
    }
    if (!time && is_first && pacing.kind == Pacing::Kind::speed) return 0;
    constexpr auto k_hint = "give the keyframe's time in seconds";
    return map.require("time", k_hint).number(k_hint);
}

void read_keyframes(const ConfigValue& value, bool is_view, TrajectoryDesc& trajectory) {
    constexpr auto k_hint = "write one '- {time: 0, position: [0, 0, 0], look_at: [0, 0, 1]}' each";
    const std::vector<ConfigValue> entries = value.list(k_hint);
    if (entries.empty()) value.fail(fmt::format("is empty; {}", k_hint));
    for (const ConfigValue& entry : entries) {
        ConfigMap map(entry, {"time", "position", "look_at", "up", "rotate", "matrix"}, k_hint);
        const std::size_t index = trajectory.keyframes.size();
        const double time = read_time(map, trajectory.pacing, index, entries.size());
        trajectory.keyframes.push_back({time, pose_of(read_pose_keys(map, is_view))});
    }
    const auto fault = Trajectory::first_fault(trajectory.keyframes, trajectory.pacing);
    if (!fault) return;
    const std::vector<TimedPose>& poses = trajectory.keyframes;
    if (trajectory.pacing.kind != Pacing::Kind::given &&
        poses[*fault].pose.position == poses[*fault - 1].pose.position)
        entries[*fault].fail(
            "has the position of the keyframe before, so that no time passes between them at the "
            "given speed; move it, or give times instead of a speed");
    entries[*fault].fail(
        fmt::format("its time of {} s is not after that of {}, {} s; order the keyframes by time",
                    poses[*fault].time,
                    trajectory.pacing.kind == Pacing::Kind::given ? "the one before" : "the first",
                    trajectory.pacing.kind == Pacing::Kind::given ? poses[*fault - 1].time
                                                                  : poses.front().time));
}

}  // namespace

TrajectoryDesc read_trajectory(const ConfigValue& value, const SceneContext& context,
                               bool is_view) {
    constexpr auto k_hint =
        "write {file: dive.tum}, or {keyframes: [{time: 0, position: [0, 0, 0], "
        "look_at: [0, 0, 1]}, ...]}";
    ConfigMap map(value,
                  {"file", "format", "start", "transform", "keyframes", "interpolation", "speed"},
                  k_hint);
    TrajectoryDesc trajectory;
    trajectory.where = value.location();
    if (const auto interpolation = map.find("interpolation")) {
        constexpr std::array<std::pair<std::string_view, Interpolation>, 2> k_kinds{
            {{"smooth", Interpolation::smooth}, {"linear", Interpolation::linear}}};
        trajectory.interpolation = interpolation->choice(k_kinds);
    }
    if (const auto speed = map.find("speed")) read_pace(*speed, trajectory.pacing);
    const auto keyframes = map.find("keyframes");
    if (const auto file = map.find("file")) {
        if (keyframes) keyframes->fail("a trajectory has either a file or keyframes; remove one");
        read_file(map, *file, context, trajectory);
    } else if (keyframes) {
        map.finish("a trajectory with 'keyframes'");
        read_keyframes(*keyframes, is_view, trajectory);
    } else {
        value.fail(fmt::format("has neither a file nor keyframes; {}", k_hint));
    }
    return trajectory;
}
}  // namespace uw
