#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/camera_desc.h"

namespace uw {

/// A file format of camera calibrations (docs/calibration.md).
enum class CalibrationFormat : std::uint8_t {
    opencv,    // YAML of OpenCV's FileStorage
    ros,       // YAML of ROS camera_info
    kalibr,    // camchain.yaml
    calibmar,  // calibration.yaml
    colmap,    // cameras.txt, stock and refractive
    scene,     // the camera of a uwvdb scene
};

/// What a calibration file says about one camera.
struct Calibration {
    CalibrationFormat format = CalibrationFormat::opencv;
    std::string camera;                // its name in the file; "" if it has none
    std::vector<std::string> cameras;  // all names in the file
    std::string model;                 // in the file's own words: "pinhole, radtan"
    /// Resolution, intrinsics (image corner at (0, 0)), distortion and port only.
    CameraDesc desc;
    std::vector<std::string> warnings;  // one line each
    std::string hash;                   // of the file's text
};

}  // namespace uw
