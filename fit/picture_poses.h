#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/vector_math.h"
#include "fit/picture_residuals.h"
#include "fit/point_residuals.h"

namespace uw {

/// Gives pictures the poses that a structure-from-motion program found for their names: COLMAP's
/// (a model's folder, or its images.txt or images.bin) or nerfstudio's (transforms.json). `images`
/// is what pictures_called takes, or a folder in which the poses' own names are looked up. A
/// picture's name is what its path ends with: "left/0001.png" of "dive/left/0001.png". Pictures
/// without a pose, and poses without a picture in the folder, are passed over, and named or counted
/// to `say` in one line each. Throws IoError as pictures_called and read_pose_file, UsageError for
/// files of poses without names, and InputError if no picture has a pose.
std::vector<ObservedPicture> posed_pictures(const std::filesystem::path& images,
                                            const std::filesystem::path& poses,
                                            const std::function<void(const std::string&)>& say);

/// Poses as nerfstudio's transforms.json has them, which posed_pictures reads: of pictures by their
/// names, world_from_camera, whose axes are x right, y down, z forward; with the standard errors of
/// positions [m] and turns [degrees], null for what is not determined.
std::string transforms_json(std::span<const std::string> names, std::span<const FoundPose> poses);

/// The same as a table: image, x, y, z, x_error, y_error, z_error [m] and turn_x_error,
/// turn_y_error, turn_z_error about the camera's axes [degrees].
std::string pose_csv(std::span<const std::string> names, std::span<const FoundPose> poses);

}  // namespace uw
