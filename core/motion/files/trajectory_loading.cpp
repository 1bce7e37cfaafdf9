#include "core/motion/files/trajectory_loading.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/motion/files/pose_file_reader.h"

namespace uw {

namespace {

/// From the file's world and times to the scene's.
std::vector<TimedPose> placed(const PoseFile& file, const TrajectoryDesc& desc, double fps) {
    const Pose world_from_file = pose_of(desc.world_from_file);
    std::vector<TimedPose> poses;
    poses.reserve(file.poses.size());
    for (const auto& [time, pose] : file.poses) {
        const double scene_time = file.counts_frames ? time / fps
                                  : desc.start       ? time + (file.first_time - *desc.start)
                                                     : time;
        const Point3 scaled = at_origin_plus(desc.scale * from_origin(pose.position));
        poses.push_back(
            {scene_time,
             {desc.world_from_file * scaled, world_from_file.rotation * pose.rotation}});
    }
    return poses;
}

}  // namespace

std::string load_trajectory(TrajectoryDesc& desc, double fps) {
    if (desc.file.empty()) {
        desc.trajectory =
            std::make_shared<Trajectory>(desc.keyframes, desc.interpolation, desc.pacing);
        return {};
    }
    const PoseFile file = read_pose_file(desc.file, desc.format, desc.where);
    const std::vector<TimedPose> poses = placed(file, desc, fps);
    if (const auto fault = Trajectory::first_fault(poses, desc.pacing))
        throw InputError(fmt::format(
            "{}: poses {} and {} of '{}' are at the same place, where no time passes at the given "
            "speed; leave 'speed' out",
            desc.where, *fault, *fault + 1, desc.file.filename().string()));
    desc.trajectory = std::make_shared<Trajectory>(poses, desc.interpolation, desc.pacing);
    return file.hash;
}

}  // namespace uw
