#include "render/resolved_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <system_error>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/geometry/gltf_import.h"
#include "core/scene/scene_limits.h"

namespace uw {

namespace {

// Times of frames and of files are rounded decimals: a frame may be this much outside [s].
constexpr double k_time_tolerance = 1e-6;
constexpr double k_always = std::numeric_limits<double>::infinity();

void for_each_trajectory(const SceneDesc& scene,
                         const std::function<void(const TrajectoryDesc&)>& take) {
    if (scene.camera.trajectory) take(*scene.camera.trajectory);
    if (scene.rig_trajectory) take(*scene.rig_trajectory);
    for (const LampDesc& lamp : scene.lamps)
        if (lamp.trajectory) take(*lamp.trajectory);
    for (const GeometryDesc& geometry : scene.geometry)
        if (geometry.trajectory) take(*geometry.trajectory);
}

// The trajectory whose poses are the frames, where they are.
const Trajectory& trajectory_of_frames(const SceneDesc& scene) {
    return scene.rig_trajectory ? *scene.rig_trajectory->trajectory
                                : *scene.camera.trajectory->trajectory;
}

/// When everything that has a trajectory has a pose.
TimeRange common_times(const SceneDesc& scene) {
    TimeRange range{-k_always, k_always};
    for_each_trajectory(scene, [&](const TrajectoryDesc& desc) {
        range.first = std::max(range.first, desc.trajectory->first_time());
        range.last = std::min(range.last, desc.trajectory->last_time());
    });
    return range;
}

/// When some file's nodes move.
TimeRange animated_times(const SceneDesc& scene) {
    TimeRange range{k_always, -k_always};
    for (const GeometryDesc& geometry : scene.geometry) {
        if (!geometry.animation) continue;
        range.first = std::min(range.first, geometry.animation->first);
        range.last = std::max(range.last, geometry.animation->last);
    }
    return range;
}

std::optional<FrameRange> frames_within(const SceneDesc& scene, const TimeRange& times) {
    constexpr double k_last_frame = 999'999'999;
    double first = std::ceil((times.first - k_time_tolerance) * scene.render.fps);
    double last = std::floor((times.last + k_time_tolerance) * scene.render.fps);
    if (scene.render.times == RenderDesc::Times::trajectory) {
        const std::vector<double>& poses = trajectory_of_frames(scene).times();
        const auto begin = std::ranges::lower_bound(poses, times.first - k_time_tolerance);
        const auto end = std::ranges::upper_bound(poses, times.last + k_time_tolerance);
        first = static_cast<double>(begin - poses.begin());
        last = static_cast<double>(end - poses.begin()) - 1;
    }
    first = std::max(first, 0.0);
    last = std::min(last, k_last_frame);
    if (!(first <= last)) return std::nullopt;
    return FrameRange{static_cast<int>(first), static_cast<int>(last)};
}

Affine pose_at(const TrajectoryDesc& desc, double time, const SceneDesc& scene,
               const std::string& subject) {
    const Trajectory& trajectory = *desc.trajectory;
    if (time >= trajectory.first_time() - k_time_tolerance &&
        time <= trajectory.last_time() + k_time_tolerance)
        return trajectory.at(time).affine();
    const std::optional<FrameRange> frames =
        frames_within(scene, {trajectory.first_time(), trajectory.last_time()});
    throw InputError(fmt::format(
        "{}: has no pose for {}, at {:.6g} s; its poses are from {:.6g} to {:.6g} s{}", desc.where,
        subject, time, trajectory.first_time(), trajectory.last_time(),
        frames ? fmt::format(", which is frames {}-{}", frames->first, frames->last) : ""));
}

/// Sets `scene.time`, and all poses to those that `pose_of` gives their trajectories.
void move_all(SceneDesc& scene, double time,
              const std::function<Affine(const TrajectoryDesc&)>& pose_of) {
    if (scene.camera.trajectory) scene.camera.world_from_camera = pose_of(*scene.camera.trajectory);
    if (scene.rig_trajectory) {
        const Affine world_from_rig = pose_of(*scene.rig_trajectory);
        const auto move = [&](Affine& world_from_mount) {
            world_from_mount = world_from_rig * world_from_mount;
        };
        move(scene.camera.world_from_camera);
        for (RigCameraDesc& entry : scene.cameras) move(entry.camera.world_from_camera);
        for (LampDesc& lamp : scene.lamps)
            if (lamp.fixed_to_rig) move(lamp.world_from_mount);
    }
    for (LampDesc& lamp : scene.lamps)
        if (lamp.trajectory) lamp.world_from_mount = pose_of(*lamp.trajectory);
    for (GeometryDesc& geometry : scene.geometry) {
        if (geometry.trajectory)
            geometry.world_from_object = pose_of(*geometry.trajectory) * geometry.world_from_object;
        if (geometry.animation) geometry.time = time;
    }
    scene.time = time;
}

}  // namespace

bool has_motion(const SceneDesc& scene) {
    bool moves = std::ranges::any_of(scene.geometry, [](const GeometryDesc& geometry) {
        return geometry.animation.has_value();
    });
    const std::optional<SnowDesc>& snow = scene.water.snow;
    moves = moves || (snow && snow->drift != Vector3(0));
    for_each_trajectory(scene, [&](const TrajectoryDesc& /*desc*/) { moves = true; });
    return moves;
}

std::optional<FrameRange> frames_of(const SceneDesc& scene) {
    TimeRange times = common_times(scene);
    if (times.first == -k_always) times = animated_times(scene);
    return frames_within(scene, times);
}

bool has_frame(const SceneDesc& scene, int frame) {
    const auto frames = frames_within(scene, common_times(scene));
    if (!frames || frame < frames->first || frame > frames->last) return false;
    return std::ranges::all_of(scene.geometry, [&](const GeometryDesc& geometry) {
        std::error_code ignored;
        return !geometry.is_sequence ||
               std::filesystem::is_regular_file(file_of_frame(geometry.file, frame), ignored);
    });
}

double time_of_frame(const SceneDesc& scene, int frame) {
    if (scene.render.times == RenderDesc::Times::fps) return frame / scene.render.fps;
    const std::vector<double>& times = trajectory_of_frames(scene).times();
    if (static_cast<std::size_t>(frame) < times.size())
        return times[static_cast<std::size_t>(frame)];
    throw InputError(fmt::format("{}: there is no frame {}; the trajectory has the poses 0-{}",
                                 scene.render.times_where, frame, times.size() - 1));
}

double first_time(const SceneDesc& scene) {
    return std::max(0.0, common_times(scene).first);
}

void set_time(SceneDesc& scene, double time, const std::string& subject) {
    move_all(scene, time,
             [&](const TrajectoryDesc& desc) { return pose_at(desc, time, scene, subject); });
}

void set_time_of_exposure(SceneDesc& scene, double time) {
    move_all(scene, time, [&](const TrajectoryDesc& desc) {
        return desc.trajectory->at_or_beyond(time).affine();
    });
}

namespace {

void refuse_open_sequences(const SceneDesc& scene) {
    const auto refuse = [](const SourceLocation& where, const std::filesystem::path& file) {
        throw InputError(
            fmt::format("{}.file: there is no '{}', and as the name of a sequence it needs frames; "
                        "render it with --frames 1-10, or name one file",
                        where, printable(file.string(), 300)));
    };
    for (const VolumeDesc& volume : scene.volumes) {
        if (volume.is_sequence) refuse(volume.where, volume.file);
        if (volume.motion && volume.motion->is_sequence)
            refuse(volume.motion->where, volume.motion->file);
    }
    for (const GeometryDesc& geometry : scene.geometry)
        if (geometry.is_sequence) refuse(geometry.where, geometry.file);
}

// Sets camera and files; a scene without a choice of either keeps its own.
void choose(SceneDesc& scene, const ImageChoice& choice) {
    scene.choice = choice;
    if (!scene.cameras.empty()) {
        scene.camera = scene.cameras[choice.camera].camera;
        scene.camera_name = scene.cameras[choice.camera].name;
    }
    if (!choice.frame) return;
    const auto choose_file = [&](auto& input) {
        if (!input.is_sequence) return;
        input.file = file_of_frame(input.file, *choice.frame);
        input.is_sequence = false;
    };
    for (VolumeDesc& volume : scene.volumes) {
        choose_file(volume);
        if (volume.motion) choose_file(*volume.motion);
    }
    std::ranges::for_each(scene.geometry, choose_file);
}

}  // namespace

SceneDesc scene_of_image(const SceneDesc& scene, const ImageChoice& choice) {
    SceneDesc result = scene;
    result.whole = std::make_shared<SceneDesc>(scene);
    choose(result, choice);
    if (!has_motion(scene)) return result;
    if (choice.frame)
        set_time(result, time_of_frame(scene, *choice.frame),
                 fmt::format("frame {}", *choice.frame));
    else
        set_time(result, first_time(scene), "the first moment");
    return result;
}

SceneDesc scene_at(const SceneDesc& scene, double time) {
    SceneDesc then = *scene.whole;
    choose(then, scene.choice);
    set_time_of_exposure(then, time);
    import_gltf(then);
    SceneDesc result = scene;
    result.time = time;
    result.camera.world_from_camera = then.camera.world_from_camera;
    for (std::size_t i = 0; i < result.geometry.size(); ++i) {
        result.geometry[i].world_from_object = then.geometry[i].world_from_object;
        result.geometry[i].time = then.geometry[i].time;
    }
    // An image may have fewer lamps than its scene.
    for (LampDesc& lamp : result.lamps) {
        const auto moved = std::ranges::find(then.lamps, lamp.name, &LampDesc::name);
        if (moved == then.lamps.end()) continue;
        lamp.position = moved->position;
        lamp.direction = moved->direction;
        lamp.world_from_mount = moved->world_from_mount;
    }
    return result;
}

ResolvedScene::ResolvedScene(SceneDesc&& scene) : desc_(std::move(scene)) {
    refuse_open_sequences(desc_);
    if (!desc_.time && has_motion(desc_)) {
        desc_.whole = std::make_shared<SceneDesc>(desc_);
        set_time(desc_, first_time(desc_), "the first moment");
    }
    import_gltf(desc_);
    check_limits(desc_);
}

}  // namespace uw
