#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "camera/calibration/camera_calibration.h"

namespace uw {

/// Every format in which calibrations are written.
std::span<const CalibrationFormat> calibration_formats();
/// "kalibr", as on the command line.
std::string_view word_of(CalibrationFormat format);
/// "Kalibr camchain", for people.
std::string_view title_of(CalibrationFormat format);

/// Reads a calibration of any format but a scene; the format is detected from the content. `camera`
/// names one of several in the file; it may be empty if there is only one. Throws IoError if the
/// file cannot be read, and InputError of one line for what is wrong in it.
Calibration read_calibration(const std::filesystem::path& file, const std::string& camera = "");

/// Reads the file that `camera.calibration` names, if it names any, into the rest of `camera`.
/// Returns what was read. Throws as read_calibration, and InputError if both the scene and the file
/// have a port.
std::optional<Calibration> apply_calibration(CameraDesc& camera);

/// Why `format` cannot express this camera, and what to do instead; empty if it can.
std::string calibration_obstacle(CalibrationFormat format, const CameraDesc& camera);

/// The camera's resolution, intrinsics, distortion and port as the text of a file, at full
/// precision. Precondition: there is no calibration_obstacle.
std::string write_calibration(CalibrationFormat format, const CameraDesc& camera);

/// One line for each property of this camera that a file of `format` leaves out.
std::vector<std::string> calibration_omissions(CalibrationFormat format, const CameraDesc& camera);

}  // namespace uw
