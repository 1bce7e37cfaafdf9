#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/motion/pose.h"

namespace uw {

/// One line of a file of poses, for messages; for the readers of this folder.
struct PoseLine {
    const std::string& origin;  // the scene entry and the file
    std::size_t number = 0;     // from 1

    /// Throws InputError "<origin>:<number>: <what>".
    [[noreturn]] void fail(const std::string& what) const;
    /// A finite number; `name` is the column's.
    double parsed(std::string_view cell, std::string_view name) const;
    /// The rotation of a quaternion of length 1 to within 1e-3.
    Rotation rotation(double w, double x, double y, double z) const;
};

/// The largest number in a file of poses.
inline constexpr double k_largest_pose_number = 1e12;

/// A pose and the name of its image.
struct NamedPose {
    std::string name;
    Pose pose;
    std::size_t line = 0;  // of the file, from 1; or its place in a list
};

/// The poses by frame (PoseFile::poses). Throws InputError for names that are the same.
std::vector<TimedPose> by_frame(std::vector<NamedPose> poses, const std::string& origin);

}  // namespace uw
