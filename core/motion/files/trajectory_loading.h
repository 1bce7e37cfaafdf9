#pragma once

#include <string>

#include "core/scene/trajectory_desc.h"

namespace uw {

/// Reads the file of poses that `desc` names, if it names any, and makes its trajectory; poses
/// without times are those of the frames, `fps` per second. Returns the hash of the file's text;
/// empty for keyframes. Throws as read_pose_file does, and InputError for poses at the same place
/// that a constant speed leaves no time for.
std::string load_trajectory(TrajectoryDesc& desc, double fps);

}  // namespace uw
