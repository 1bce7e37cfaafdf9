#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/camera_desc.h"
#include "core/scene/config_value.h"

namespace uw {

/// A file format of camera calibrations (docs/calibration.md).
enum class CalibrationFormat : std::uint8_t {
    opencv,    // YAML of OpenCV's FileStorage
    ros,       // YAML of ROS camera_info
    kalibr,    // camchain.yaml
    calibmar,  // calibration.yaml
    colmap,    // cameras.txt, stock and refractive
    scene,     // the camera of a uwvdb scene
    // These are read only.
    euroc,      // sensor.yaml of EuRoC's (ASL's) cameras
    okvis,      // the list `cameras` of OKVIS's settings
    orb_slam,   // settings of ORB-SLAM
    camodocal,  // CamOdoCal's cameras, which VINS and Pinax read
    matisse,    // Matisse's cameras
};

/// The contents of a calibration file about one camera.
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

/// Helpers shared by the readers and writers of the formats. Private to this folder.

/// OpenCV, ROS and Kalibr place the centre of the first pixel at (0, 0), uwvdb and COLMAP at (0.5,
/// 0.5).
inline constexpr double k_half_pixel = 0.5;

/// The numbers of a matrix: {rows, cols, data: [...]}, or a plain list.
std::vector<ConfigValue> matrix_numbers(const ConfigValue& value, std::string_view hint);

/// fx, fy, cx and cy of a file in which the centre of the first pixel is at (0, 0).
IntrinsicsDesc intrinsics_from_zero(std::span<const ConfigValue> fx_fy_cx_cy,
                                    std::string_view hint);

/// A lens of OpenCV's, k1 k2 p1 p2 k3 k4 k5 k6, of which the last may be missing; and its fisheye,
/// k1 k2 k3 k4.
DistortionDesc opencv_lens(std::span<const double> coefficients);
DistortionDesc fisheye_lens(std::span<const double> coefficients);

/// One reader per format. `root` is the whole document; all throw InputError.
Calibration read_opencv_yaml(const ConfigValue& root);
Calibration read_euroc_sensor(const ConfigValue& root);
Calibration read_okvis(const ConfigValue& root, const std::string& camera);
Calibration read_orb_slam(const ConfigValue& root, const std::string& camera);
Calibration read_camodocal(const ConfigValue& root);
Calibration read_matisse(const ConfigValue& root);
Calibration read_kalibr(const ConfigValue& root, const std::string& camera);
Calibration read_calibmar(const ConfigValue& root);
/// `origin` names the file in messages.
Calibration read_colmap(std::string_view text, const std::string& origin,
                        const std::string& camera);

/// Whether the document looks like one of this format, however wrong its details.
bool looks_like_opencv(const ConfigNode& root);
bool looks_like_euroc(const ConfigNode& root);
bool looks_like_okvis(const ConfigNode& root);
bool looks_like_orb_slam(const ConfigNode& root);
bool looks_like_camodocal(const ConfigNode& root);
bool looks_like_matisse(const ConfigNode& root);
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
ConfigValue require_value(const ConfigValue& map, std::string_view key, std::string_view hint);

/// "[1, 2.5, 3]", at full precision.
std::string number_list(std::span<const double> numbers);

/// The requested one of several cameras, or the only one. Throws InputError at `where`.
std::string choose_camera(const std::vector<std::string>& names, const std::string& wanted,
                          const std::string& where);

/// Whether the lens has any distortion; any radial coefficient beyond the first `count`.
bool is_distorted(const DistortionDesc& distortion);
bool has_radial_above(const DistortionDesc& distortion, std::size_t count);

/// Every format in which calibrations are written.
std::span<const CalibrationFormat> calibration_formats();
/// "kalibr", as on the command line.
std::string_view word_of(CalibrationFormat format);
/// "Kalibr camchain", for messages.
std::string_view title_of(CalibrationFormat format);

/// Reads a calibration of any format but a scene; the format is detected from the content. `camera`
/// names one of several in the file; it may be empty if there is only one. A principal point
/// outside the image is warned of. Throws IoError if the file cannot be read, and InputError of one
/// line for what is wrong in it.
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

/// A camera of a Kalibr chain with an IMU.
struct ChainedCamera {
    CameraDesc desc;         // as for CalibrationFormat::kalibr
    Affine camera_from_imu;  // rigid
};

/// Kalibr's camchain-imucam.yaml: the cameras as cam0, cam1, ... with T_cam_imu and T_cn_cnm1, on
/// one clock. Precondition: no camera has a calibration_obstacle for Kalibr.
std::string write_kalibr_chain(std::span<const ChainedCamera> cameras);

/// One line for each property of this camera that a file of `format` leaves out.
std::vector<std::string> calibration_omissions(CalibrationFormat format, const CameraDesc& camera);

}  // namespace uw
