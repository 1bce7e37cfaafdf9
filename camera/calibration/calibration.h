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
/// "kalibr", as the command line has it.
std::string_view word_of(CalibrationFormat format);
/// "Kalibr camchain", for people.
std::string_view title_of(CalibrationFormat format);

/// Reads a calibration of any format but a scene; which one is found out from the content.
/// `camera` names one of several in the file; it may be empty where there is one. Throws IoError if
/// the file cannot be read, and InputError of one line for what is wrong in it.
Calibration read_calibration(const std::filesystem::path& file, const std::string& camera = "");

/// Reads what `camera.calibration` names, if it names anything, into the rest of `camera`, whose
/// port it may leave alone but not replace. Returns what was read. Throws as read_calibration.
std::optional<Calibration> apply_calibration(CameraDesc& camera);

/// Why `format` cannot express this camera, with the mend; empty if it can.
std::string calibration_obstacle(CalibrationFormat format, const CameraDesc& camera);

/// The camera's resolution, intrinsics, distortion and port as the text of a file, with all digits.
/// Precondition: there is no calibration_obstacle.
std::string write_calibration(CalibrationFormat format, const CameraDesc& camera);

/// What `format` leaves out of this camera though it can be written: one line each.
std::vector<std::string> calibration_omissions(CalibrationFormat format, const CameraDesc& camera);

}  // namespace uw
