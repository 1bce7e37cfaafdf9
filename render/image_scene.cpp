#include "render/image_scene.h"

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

// Times of frames and of files are rounded decimals, so that a frame may lie outside of them by
// this much [s].
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

// Returns the trajectory whose poses are the frames, if frames are poses.
const Trajectory& trajectory_of_frames(const SceneDesc& scene) {
    return scene.rig_trajectory ? *scene.rig_trajectory->trajectory
                                : *scene.camera.trajectory->trajectory;
}

/// Returns the times at which everything that has a trajectory has a pose.
TimeRange common_times(const SceneDesc& scene) {
    TimeRange range{-k_always, k_always};
    for_each_trajectory(scene, [&](const TrajectoryDesc& desc) {
        range.first = std::max(range.first, desc.trajectory->first_time());
        range.last = std::min(range.last, desc.trajectory->last_time());
    });
    return range;
}

/// Returns the times at which the nodes of some file move.
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
    const bool is_within_a_frame =
        scene.render.times == RenderDesc::Times::fps && trajectory.times().size() > 1 &&
        (trajectory.last_time() - trajectory.first_time()) * scene.render.fps < 1;
    throw InputError(fmt::format(
        "{}: has no pose for {}, at {:.6g} s; its poses are from {:.6g} to {:.6g} s{}{}",
        desc.where, subject, time, trajectory.first_time(), trajectory.last_time(),
        frames ? fmt::format(", which is frames {}-{}", frames->first, frames->last) : "",
        is_within_a_frame ? ": less than a frame; check the unit of their times, or write "
                            "render.times: trajectory if each pose is a frame"
                          : ""));
}

/// Sets all poses to those at `time`, which `pose_of` returns for their trajectories.
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

void choose_file(auto& input, int frame) {
    if (!input.is_sequence) return;
    input.file = file_of_frame(input.file, frame);
    input.is_sequence = false;
}

// Sets the chosen camera and files; without a choice, those of the scene stay.
void choose(SceneDesc& scene, const ImageChoice& choice) {
    if (!scene.cameras.empty()) {
        scene.camera = scene.cameras[choice.camera].camera;
        scene.camera_name = scene.cameras[choice.camera].name;
    }
    if (!choice.frame) return;
    for (VolumeDesc& volume : scene.volumes)
        volume = volume_of_frame(std::move(volume), *choice.frame);
    for (GeometryDesc& geometry : scene.geometry) choose_file(geometry, *choice.frame);
}

std::optional<double> moment_of(const SceneDesc& whole, const ImageChoice& choice) {
    if (!has_motion(whole)) return std::nullopt;
    return choice.frame ? time_of_frame(whole, *choice.frame) : first_time(whole);
}

/// Returns the scene that an image shows, without the parts of glTF files.
SceneDesc chosen(const SceneDesc& whole, const ImageChoice& choice) {
    SceneDesc scene = whole;
    choose(scene, choice);
    const std::optional<double> time = moment_of(whole, choice);
    if (!time) return scene;
    const std::string subject =
        choice.frame ? fmt::format("frame {}", *choice.frame) : "the first moment";
    move_all(scene, *time,
             [&](const TrajectoryDesc& desc) { return pose_at(desc, *time, whole, subject); });
    return scene;
}

}  // namespace

VolumeDesc volume_of_frame(VolumeDesc volume, int frame) {
    choose_file(volume, frame);
    if (volume.motion) choose_file(*volume.motion, frame);
    return volume;
}

Affine world_from_camera(const SceneDesc& whole, const ImageChoice& choice) {
    const SceneDesc scene = chosen(whole, choice);
    if (scene.camera.has_pose) return scene.camera.world_from_camera;
    return scene_of_image(whole, choice)
        .desc()
        .camera.world_from_camera;  // the camera is from a glTF file
}

void check_moment(const SceneDesc& whole, const ImageChoice& choice) {
    chosen(whole, choice);
}

ImageScene::ImageScene(std::shared_ptr<const SceneDesc> whole, const ImageChoice& choice)
    : whole_(std::move(whole)),
      choice_(choice),
      time_(moment_of(*whole_, choice)),
      desc_(chosen(*whole_, choice)) {
    refuse_open_sequences(desc_);
    import_gltf(desc_);
    check_limits(desc_);
}

ImageScene::ImageScene(SceneDesc&& whole, const ImageChoice& choice)
    : ImageScene(std::make_shared<const SceneDesc>(std::move(whole)), choice) {}

ImageScene scene_of_image(const SceneDesc& whole, const ImageChoice& choice) {
    return {SceneDesc(whole), choice};
}

ImageScene ImageScene::with(const std::function<void(SceneDesc&)>& change) const {
    ImageScene result = *this;
    change(result.desc_);
    return result;
}

ImageScene ImageScene::at(double time) const {
    SceneDesc then = *whole_;
    choose(then, choice_);
    move_all(then, time, [&](const TrajectoryDesc& desc) {
        return desc.trajectory->at_or_beyond(time).affine();
    });
    import_gltf(then);
    ImageScene result = *this;
    result.time_ = time;
    result.desc_.camera.world_from_camera = then.camera.world_from_camera;
    for (std::size_t i = 0; i < result.desc_.geometry.size(); ++i) {
        result.desc_.geometry[i].world_from_object = then.geometry[i].world_from_object;
        result.desc_.geometry[i].time = then.geometry[i].time;
    }
    // An image may have fewer lamps than its scene.
    for (LampDesc& lamp : result.desc_.lamps) {
        const auto moved = std::ranges::find(then.lamps, lamp.name, &LampDesc::name);
        if (moved == then.lamps.end()) continue;
        lamp.position = moved->position;
        lamp.direction = moved->direction;
        lamp.world_from_mount = moved->world_from_mount;
    }
    return result;
}

ImageScene ImageScene::seen_by(std::size_t camera) const {
    ImageScene result = *this;
    result.choice_.camera = camera;
    result.desc_.camera = desc_.cameras[camera].camera;
    result.desc_.camera_name = desc_.cameras[camera].name;
    return result;
}

std::optional<ImageScene> ImageScene::neighbour(int step) const {
    if (!choice_.frame || !has_frame(*whole_, *choice_.frame + step)) return std::nullopt;
    return ImageScene(whole_, {*choice_.frame + step, choice_.camera});
}

}  // namespace uw
