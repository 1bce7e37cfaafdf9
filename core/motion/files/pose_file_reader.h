#pragma once

#include <filesystem>
#include <string>

#include "core/motion/files/pose_file.h"
#include "core/scene/trajectory_desc.h"

namespace uw {

/// Reads a file of poses. `subject` is what messages begin with: the scene entry that names the
/// file. Quaternions and matrices are normalised; they may be off by 1e-3 from rounding. Throws
/// IoError, and InputError of one line: a number that is missing or none, not a rotation, times
/// that do not ascend, images of the same name, no pose or more than k_most_poses.
///
/// - TUM: `timestamp tx ty tz qx qy qz qw`, world_from_body, '#' comments.
/// - EuRoC (ASL): CSV of ns, x, y, z, qw, qx, qy, qz and perhaps more; world_from_body.
/// - COLMAP's images.txt: camera_from_world, w first, every other line skipped.
/// - nerfstudio's transforms.json: world_from_camera with y up and -z forward in the camera.
PoseFile read_pose_file(const std::filesystem::path& file, PoseFormat format,
                        const std::string& subject);

}  // namespace uw
