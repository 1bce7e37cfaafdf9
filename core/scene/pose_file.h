#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/trajectory.h"

namespace uw {

/// The poses of a file, world_from_body in the file's own world and units; a camera's axes are x
/// right, y down, z forward.
struct PoseFile {
    /// The times are seconds after the first pose where the file has times, and frame numbers where
    /// it has none: those at the end of the images' names if these are otherwise the same, else
    /// their places from 0, in the order of the names.
    std::vector<TimedPose> poses;      // at least one, strictly ascending
    bool counts_frames = false;        // times are frame numbers
    std::vector<std::int64_t> stamps;  // the poses' own times [ns]; empty if they count frames
    std::string hash;                  // of the file's text
};

/// The most poses that a file may have.
inline constexpr std::size_t k_max_poses = 1'000'000;

/// Reads a file of poses. `subject` is what messages begin with: the scene entry that names the
/// file. Quaternions and matrices are normalised; they may be off by 1e-3 from rounding. Throws
/// IoError, and InputError of one line: a number that is missing or none, not a rotation, times
/// that do not ascend, images of the same name, no pose or more than k_max_poses.
///
/// Times are exact to the nanosecond, whatever the clock.
///
/// - TUM: `timestamp tx ty tz qx qy qz qw`, world_from_body, '#' comments; seconds, rounded
///   to nanoseconds.
/// - EuRoC (ASL): CSV of ns, x, y, z, qw, qx, qy, qz and perhaps more; world_from_body.
/// - COLMAP's images.txt, camera_from_world, w first, every other line skipped; or images.bin, by
///   the name's ending, the same in binary form.
/// - nerfstudio's transforms.json: world_from_camera with y up and -z forward in the camera.
PoseFile read_pose_file(const std::filesystem::path& file, PoseFormat format,
                        const std::string& subject);

/// The pose of an image.
struct NamedPose {
    std::string name;      // the image's file, as the file of poses has it
    Pose pose;             // as in PoseFile
    std::size_t line = 0;  // of the file, from 1; or its place in a list
};

/// The poses of COLMAP's and nerfstudio's files by the images' names, in their alphabetical order;
/// at least one. Throws as read_pose_file. Precondition: `format` is one of these.
std::vector<NamedPose> read_named_poses(const std::filesystem::path& file, PoseFormat format,
                                        const std::string& subject);

/// The format by the file's name, where that leaves no doubt.
std::optional<PoseFormat> pose_format_called(const std::filesystem::path& file);

/// A pose of a file where the scene has it: scaled, then moved (TrajectoryDesc::world_from_file).
Pose placed(const Pose& pose, const TrajectoryDesc& desc);

/// Reads the file of poses that `desc` names, if it names any, and makes its trajectory; poses
/// without times are those of the frames, `fps` per second. Returns the hash of the file's text;
/// empty for keyframes. `doubt` becomes a remark if the file's times seem not to have the unit of
/// its format, such as frame numbers; else empty. Throws as read_pose_file does, and InputError for
/// a start at which poses cannot be distinguished, and for poses at the same position, between
/// which a constant speed allows no time.
std::string load_trajectory(TrajectoryDesc& desc, double fps, std::string& doubt);

/// A time in whole nanoseconds; none after the year 2116.
std::optional<std::int64_t> nanoseconds(double seconds);

/// The clock of a file of poses [ns]. Whole numbers are used because seconds as doubles resolve
/// only 200 ns of a time that is counted from 1970.
struct PoseClock {
    std::int64_t zero = 0;             // at the scene's time 0
    std::vector<std::int64_t> stamps;  // at each pose; empty where a pace gives them other times
};

/// Reads the file that `desc` names for its clock; none for keyframes and files without times.
/// Throws as load_trajectory, and InputError if the file is no longer what the trajectory was made
/// of.
std::optional<PoseClock> read_pose_clock(const TrajectoryDesc& desc);
}  // namespace uw
