#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "camera/calibration/camera_calibration.h"
#include "core/scene/yaml/config_map.h"
#include "core/scene/yaml/config_value.h"

namespace uw {

/// What the readers and writers of the formats share. Private to this folder.

/// OpenCV, ROS and Kalibr place the centre of the first pixel at (0, 0), uwvdb and COLMAP at (0.5,
/// 0.5).
inline constexpr double k_half_pixel = 0.5;

/// One reader per format. `root` is the whole document; all throw InputError.
Calibration read_opencv_yaml(const ConfigValue& root);
Calibration read_kalibr(const ConfigValue& root, const std::string& camera);
Calibration read_calibmar(const ConfigValue& root);
/// `origin` names the file in messages.
Calibration read_colmap(std::string_view text, const std::string& origin,
                        const std::string& camera);

/// Whether the document looks like one of this format, however wrong its details.
bool looks_like_opencv(const ConfigNode& root);
bool looks_like_kalibr(const ConfigNode& root);
bool looks_like_calibmar(const ConfigNode& root);
bool looks_like_colmap(std::string_view text);

/// Why a format cannot express this camera; empty if it can.
std::string opencv_obstacle(const CameraDesc& camera);
std::string kalibr_obstacle(const CameraDesc& camera);

/// One writer per format.
std::string write_opencv(const CameraDesc& camera);
std::string write_ros(const CameraDesc& camera);
std::string write_kalibr(const CameraDesc& camera);
std::string write_calibmar(const CameraDesc& camera);
std::string write_colmap(const CameraDesc& camera);
std::string write_scene_camera(const CameraDesc& camera);

/// The value of a key, in a document that may have keys which are not read. Throws InputError if it
/// is missing.
ConfigValue require_value(const ConfigValue& map, std::string_view key, std::string_view mend);

/// "[1, 2.5, 3]", at full precision.
std::string number_list(std::span<const double> numbers);

/// Names for a message: the first few of them.
std::string some_names(const std::vector<std::string>& names);

/// The requested one of several cameras, or the only one. Throws InputError at `where`.
std::string choose_camera(const std::vector<std::string>& names, const std::string& wanted,
                          const std::string& where);

/// Whether the lens has any distortion; any radial coefficient beyond the first `count`.
bool is_distorted(const DistortionDesc& distortion);
bool has_radial_above(const DistortionDesc& distortion, std::size_t count);

}  // namespace uw
