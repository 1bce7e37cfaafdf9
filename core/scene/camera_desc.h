#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "core/scene/config_value.h"
#include "core/scene/dispersion.h"
#include "core/scene/scene_context.h"
#include "core/scene/sensor_desc.h"
#include "core/scene/trajectory.h"

namespace uw {

/// The camera of a scene as inert data (docs/scene-file.md). Lengths in metres, angles in degrees.

/// A camera matrix [pixels]; the image's corner is (0, 0).
struct IntrinsicsDesc {
    double fx = 0, fy = 0;  ///< focal lengths, > 0
    double cx = 0, cy = 0;  ///< principal point

    friend bool operator==(const IntrinsicsDesc&, const IntrinsicsDesc&) = default;
};

/// A lens's deviation from a pinhole, with OpenCV's coefficients.
struct DistortionDesc {
    enum class Model { brown_conrady, fisheye };
    /// brown_conrady: k1..k6, rational when k4..k6 are not 0; fisheye (equidistant): k1..k4.
    std::array<double, 6> k{};
    std::array<double, 2> p{};  ///< brown_conrady: p1, p2
    Model model = Model::brown_conrady;

    friend bool operator==(const DistortionDesc&, const DistortionDesc&) = default;
};

/// Those of the materials before, in and behind a port whose indices depend on the wavelength; the
/// port's numbers are their indices at the camera's wavelength (set_wavelength).
struct PortDispersion {
    std::optional<DispersionDesc> air{}, glass{}, water{};

    bool any() const { return air || glass || water; }
    friend bool operator==(const PortDispersion&, const PortDispersion&) = default;
};

/// A flat window, camera frame.
struct FlatPortDesc {
    Vector3 normal{0, 0, 1};  ///< unit, z > 0
    double distance = 0;      ///< camera centre to inner glass surface, along the normal [m]
    double thickness = 0;     ///< of the glass [m]
    double n_air = 1.0, n_glass = 1.49, n_water = 1.334;  ///< refractive indices, 1..3
    bool fresnel = false;                                 ///< reflection losses at both surfaces
    bool radiance_in_air = false;  ///< the camera's radiance is that in air, not in water
    PortDispersion dispersion{};

    friend bool operator==(const FlatPortDesc&, const FlatPortDesc&) = default;
};

/// A window between two concentric spheres, camera frame.
struct DomePortDesc {
    Point3 center;         ///< of both spheres, nearer to the camera centre than `radius` [m]
    double radius = 0;     ///< of the inner glass surface, > 0 [m]
    double thickness = 0;  ///< of the glass [m]
    double n_air = 1.0, n_glass = 1.49, n_water = 1.334;  ///< refractive indices, 1..3
    bool fresnel = false;                                 ///< reflection losses at both surfaces
    bool radiance_in_air = false;  ///< the camera's radiance is that in air, not in water
    PortDispersion dispersion{};

    friend bool operator==(const DomePortDesc&, const DomePortDesc&) = default;
};

/// The port that separates the camera from the water.
using PortDesc = std::variant<FlatPortDesc, DomePortDesc>;

/// The properties of a lens that affect the light on the sensor.
struct LensDesc {
    double f_number = 0;      ///< > 0
    double focal_length = 0;  ///< > 0 [m]
    double transmission = 1;  ///< fraction of the light transmitted, 0..1
    /// From the camera's centre, along the axis, to the plane in focus, in water behind a port [m];
    /// none: all distances are in focus.
    std::optional<double> focus_distance{};
};

/// A file that contains a camera's resolution, intrinsics, distortion and, perhaps, port.
struct CalibrationDesc {
    std::filesystem::path file;
    std::string camera;  ///< which of several cameras in it; empty: the only one
    SourceLocation where;
};

/// A camera: image, lens, port and pose.
struct CameraDesc {
    int width = 0, height = 0;  ///< [pixels]; 0 while `calibration` is to be read
    IntrinsicsDesc intrinsics;
    DistortionDesc distortion;
    std::optional<PortDesc> port;
    /// The wavelength in vacuum for which the port's indices, and thus all rays, are valid [nm].
    double wavelength_nm = 550;
    std::optional<LensDesc> lens;
    std::optional<SensorDesc> sensor;
    Affine world_from_camera;  ///< rigid; x right, y down, z forward
    /// How it moves; then world_from_camera is that of the scene's moment
    /// (render/image_scene.h).
    std::optional<TrajectoryDesc> trajectory;
    /// A rolling shutter: from the exposure of one row to that of the next [s]; 0: all at once.
    double line_time = 0;
    /// The source of resolution, intrinsics, distortion and port, if they are not in the scene
    /// (camera/calibration.h).
    std::optional<CalibrationDesc> calibration;
    /// Whether they are given by the scene file itself or by a calibration; else they are those of
    /// a glTF camera, once import_gltf has run.
    bool has_intrinsics = true, has_pose = true;
    SourceLocation where;
};

/// Whether the camera's rays depend on the wavelength.
bool disperses(const CameraDesc& camera);

/// Changes the wavelength of the camera [nm]: sets those of its port's indices that depend on it.
void set_wavelength(CameraDesc& camera, double wavelength_nm);

/// The band, one of `bands_nm`, at whose wavelength a scene's ground truth and calibration hold,
/// where rays depend on it: the nearest to 550 nm, of two the first.
double reference_wavelength(std::span<const double> bands_nm);

/// One camera of a rig.
struct RigCameraDesc {
    std::string name;  ///< of its files; unique in the rig
    CameraDesc camera;
};

/// The longest side of an image [pixels].
inline constexpr int k_longest_image_side = 32768;
/// The reason why an image of this size is rejected, with the hint; "" if it is not.
std::string too_many_pixels(int width, int height);

/// Readers for the parts of a camera that calibration files contain, too: resolution and port. All
/// throw InputError at the value.

/// Sets the resolution [pixels]; `both` is the location of the pair, for messages.
void read_resolution(const ConfigValue& both, const ConfigValue& width, const ConfigValue& height,
                     CameraDesc& camera);

/// `port` of a camera.
PortDesc read_port(const ConfigValue& value, const SceneContext& context);

/// A refractive index that is a number.
double read_refractive_index(const ConfigValue& value);

/// Checks that the glass lies in front of the camera; `normal` is unit.
void check_port_normal(const ConfigValue& at, const Vector3& normal);

/// Checks that the camera is inside its dome.
void check_dome(const ConfigValue& at, const DomePortDesc& dome);

/// `camera`, or one of `cameras` without its name.
CameraDesc read_camera(const ConfigValue& value, const SceneContext& context);

/// `cameras` and `rig`; also sets the frames that lamps of a rig are fixed to, and how it moves.
std::vector<RigCameraDesc> read_cameras(const ConfigValue& value,
                                        const std::optional<ConfigValue>& rig,
                                        SceneContext& context);

}  // namespace uw
