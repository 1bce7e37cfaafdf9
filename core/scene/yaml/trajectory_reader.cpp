#include "core/scene/yaml/trajectory_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "core/scene/yaml/config_map.h"
#include "core/scene/yaml/name_reader.h"
#include "core/scene/yaml/pose_reader.h"

namespace uw {
namespace {

constexpr auto k_formats = std::to_array<std::pair<std::string_view, PoseFormat>>(
    {{"tum", PoseFormat::tum},
     {"euroc", PoseFormat::euroc},
     {"colmap", PoseFormat::colmap},
     {"nerfstudio", PoseFormat::nerfstudio}});

/// By the file's name, where it leaves no doubt.
PoseFormat format_of(const ConfigValue& file, const std::filesystem::path& name) {
    const std::string extension = name.extension().string();
    if (extension == ".tum") return PoseFormat::tum;
    if (extension == ".csv") return PoseFormat::euroc;
    if (extension == ".json") return PoseFormat::nerfstudio;
    if (name.filename() == "images.txt") return PoseFormat::colmap;
    if (name.filename() == "images.bin")
        file.fail(
            "is COLMAP's binary form; convert it with 'colmap model_converter --output_type TXT' "
            "and give images.txt");
    file.fail(
        "its name does not say how it is written; add format: tum, euroc, colmap or "
        "nerfstudio");
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
    constexpr auto k_mend = "give the keyframe's time in seconds";
    return map.require("time", k_mend).number(k_mend);
}

void read_keyframes(const ConfigValue& value, bool is_view, TrajectoryDesc& trajectory) {
    constexpr auto k_mend = "write one '- {time: 0, position: [0, 0, 0], look_at: [0, 0, 1]}' each";
    const std::vector<ConfigValue> entries = value.list(k_mend);
    if (entries.empty()) value.fail(fmt::format("is empty; {}", k_mend));
    for (const ConfigValue& entry : entries) {
        ConfigMap map(entry, {"time", "position", "look_at", "up", "rotate", "matrix"}, k_mend);
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
    constexpr auto k_mend =
        "write {file: dive.tum}, or {keyframes: [{time: 0, position: [0, 0, 0], "
        "look_at: [0, 0, 1]}, ...]}";
    ConfigMap map(value,
                  {"file", "format", "start", "transform", "keyframes", "interpolation", "speed"},
                  k_mend);
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
        value.fail(fmt::format("has neither a file nor keyframes; {}", k_mend));
    }
    return trajectory;
}

}  // namespace uw
