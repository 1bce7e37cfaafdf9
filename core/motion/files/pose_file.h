#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/motion/pose.h"

namespace uw {

/// The poses of a file, world_from_body in the file's own world and units; a camera's axes are x
/// right, y down, z forward.
struct PoseFile {
    /// Of files with times: seconds after `first_time`. Of others, frame numbers: those at the end
    /// of the images' names if these are otherwise the same, else their places from 0, in the order
    /// of the names.
    std::vector<TimedPose> poses;  // at least one, strictly ascending
    bool counts_frames = false;    // as said above
    double first_time = 0;         // [s]
    std::string hash;              // of the file's text
};

/// The most poses that a file may have.
inline constexpr std::size_t k_most_poses = 1'000'000;

}  // namespace uw
