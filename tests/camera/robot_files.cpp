// ctest labels: unit analytic
// Cameras as the files of robots and of visual odometry have them: ROS's camera_info as it is
// printed, EuRoC, OKVIS, ORB-SLAM, CamOdoCal and Matisse. Where a point is seen is computed here by
// the formulas of the programs that read these files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "camera/calibration.h"
#include "camera/camera.h"
#include "tests/support/calibration_reading.h"

namespace uw {
namespace {

using test::replaced;

/// ros2 topic echo --once /camera/camera_info, and as it prints one message of many.
const std::string k_camera_info = R"(header:
  stamp:
    sec: 1735262988
    nanosec: 641024223
  frame_id: left_camera_optical_frame
height: 720
width: 1280
distortion_model: plumb_bob
d:
- -0.17
- 0.028
- 0.0011
- -0.0007
- 0.003
k:
- 522.5
- 0.0
- 632.25
- 0.0
- 521.75
- 362.125
- 0.0
- 0.0
- 1.0
r:
- 1.0
- 0.0
- 0.0
- 0.0
- 1.0
- 0.0
- 0.0
- 0.0
- 1.0
p:
- 500.0
- 0.0
- 630.0
- 0.0
- 0.0
- 500.0
- 360.0
- 0.0
- 0.0
- 0.0
- 1.0
- 0.0
binning_x: 0
binning_y: 0
roi:
  x_offset: 0
  y_offset: 0
  height: 0
  width: 0
  do_rectify: false
---
)";

/// EuRoC's cam0/sensor.yaml.
const std::string k_euroc = R"(# General sensor definitions.
sensor_type: camera
comment: VI-Sensor cam0 (MT9M034)

# Sensor extrinsics wrt. the body-frame.
T_BS:
  cols: 4
  rows: 4
  data: [0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,
         0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,
        -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,
         0.0, 0.0, 0.0, 1.0]

# Camera specific definitions.
rate_hz: 20
resolution: [752, 480]
camera_model: pinhole
intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv
distortion_model: radial-tangential
distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]
)";

/// OKVIS's settings, whose cameras have no names.
const std::string k_okvis = R"(%YAML:1.0
cameras:
     - {T_SC:
        [ 0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,
          0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,
          -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,
           0.0, 0.0, 0.0, 1.0],
        image_dimension: [752, 480],
        distortion_coefficients: [-0.28340811217, 0.0739590738929, 0.000193595028569, 1.76187114545e-05],
        distortion_type: radialtangential,
        focal_length: [458.654880721, 457.296696463],
        principal_point: [367.215803962, 248.37534061]}

     - {T_SC:
        [ 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
        image_dimension: [512, 512],
        distortion_coefficients: [0.0034823894, 0.0007150348, -0.0020532361, 0.00020293673],
        distortion_type: equidistant,
        focal_length: [190.97847, 190.97330],
        principal_point: [254.93170, 256.89744]}

camera_params:
    camera_rate: 20 # just to manage the expectations
imu_params:
    a_max: 176.0 # acceleration saturation [m/s^2]
displayImages: true  # displays debug video and keyframe matches. May be slow.
)";

/// ORB-SLAM3's, as its examples for EuRoC and TUM-VI are; the first ones had no digit after Camera.
const std::string k_orb_slam = R"(%YAML:1.0

#--------------------------------------------------------------------------------------------
# Camera Parameters. Adjust them!
#--------------------------------------------------------------------------------------------
File.version: "1.0"

Camera.type: "PinHole"

# Camera calibration and distortion parameters (OpenCV)
Camera1.fx: 458.654
Camera1.fy: 457.296
Camera1.cx: 367.215
Camera1.cy: 248.375

Camera1.k1: -0.28340811
Camera1.k2: 0.07395907
Camera1.p1: 0.00019359
Camera1.p2: 1.76187114e-05

Camera.width: 752
Camera.height: 480

Camera.newWidth: 600
Camera.newHeight: 350

# Camera frames per second
Camera.fps: 20
Camera.RGB: 1
ORBextractor.nFeatures: 1000
Viewer.PointSize:2
Viewer.KeyFrameSize: 0.05
)";

const std::string k_orb_slam_fisheye = R"(%YAML:1.0

Camera.type: "KannalaBrandt8"
Camera.fx: 190.97847715128717
Camera.fy: 190.9733070521226
Camera.cx: 254.93170605935475
Camera.cy: 256.8974428996504
Camera.k1: 0.0034823894022493434
Camera.k2: 0.0007150348452162257
Camera.k3: -0.0020532361418706202
Camera.k4: 0.00020293673591811182
Camera2.fx: 190.44236969414825
Camera2.fy: 190.4344384721956
Camera2.cx: 252.59949716835982
Camera2.cy: 254.91723064636983
Camera2.k1: 0.0034003170790442797
Camera2.k2: 0.001766278153469831
Camera2.k3: -0.00266312569781606
Camera2.k4: 0.0003299517423931039
Camera.width: 512
Camera.height: 512
Tlr: !!opencv-matrix
  rows: 3
  cols: 4
  dt: f
  data: [ 1.0, 0.0, 0.0, 0.1,
            0.0, 1.0, 0.0, 0.0,
            0.0, 0.0, 1.0, 0.0]
)";

const std::string k_orb_slam_rectified = R"(%YAML:1.0

Camera.type: "PinHole"
Camera.fx: 435.2046959714599
Camera.fy: 435.2046959714599
Camera.cx: 367.4517211914062
Camera.cy: 252.2008514404297
Camera.k1: 0.0
Camera.k2: 0.0
Camera.p1: 0.0
Camera.p2: 0.0
Camera.width: 752
Camera.height: 480
LEFT.height: 480
LEFT.width: 752
LEFT.D: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data:[-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05, 0.0]
LEFT.K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [458.654, 0.0, 367.215, 0.0, 457.296, 248.375, 0.0, 0.0, 1.0]
)";

/// As CamOdoCal writes them, and VINS-Mono's and Pinax's settings have them.
const std::string k_camodocal = R"(%YAML:1.0
---
model_type: PINHOLE
camera_name: camera
image_width: 752
image_height: 480
distortion_parameters:
   k1: -2.917e-01
   k2: 8.228e-02
   p1: 5.333e-05
   p2: -1.578e-04
projection_parameters:
   fx: 4.616e+02
   fy: 4.603e+02
   cx: 3.630e+02
   cy: 2.481e+02
)";

const std::string k_camodocal_fisheye = R"(%YAML:1.0
---
model_type: KANNALA_BRANDT
camera_name: left
image_width: 688
image_height: 516
projection_parameters:
   k2: -1.2e-02
   k3: 3.0e-03
   k4: -4.0e-04
   k5: 2.0e-05
   mu: 3.15e+02
   mv: 3.16e+02
   u0: 3.44e+02
   v0: 2.58e+02
)";

const std::string k_matisse = R"(%YAML:1.0
---
camera_name: Ulyx Still Camera
full_sensor_width: 4864
full_sensor_height: 3232
K: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 3.0429699999999998e+03, 0., 2.2811999999999998e+03, 0.,
       3.0566199999999999e+03, 1.6633599999999999e+03, 0., 0., 1. ]
distortion_model: 1
distortion_coeff: !!opencv-matrix
   rows: 1
   cols: 5
   dt: d
   data: [ -0.21, 0.07, 0.001, -0.002, 0.0125 ]
vehicle_to_camera_transform: !!opencv-matrix
   rows: 1
   cols: 6
   dt: d
   data: [ 0., 0., 0., 0., 0., -1.5707963267948966e+00 ]
)";

struct Pixel {
    double u = 0, v = 0;
};

struct Intrinsics {
    double fx = 0, fy = 0, cx = 0, cy = 0;
};

/// cv::projectPoints (OpenCV's documentation of calib3d), its first pixel's centre at (0, 0).
Pixel opencv_pixel(const Intrinsics& k, const std::array<double, 8>& d, const Vector3& p) {
    const auto [k1, k2, p1, p2, k3, k4, k5, k6] = d;
    const double x = p.x / p.z, y = p.y / p.z, r2 = x * x + y * y;
    const double radial =
        (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
    const double u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
    const double v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
    return {k.fx * u + k.cx, k.fy * v + k.cy};
}

/// cv::fisheye, Kannala and Brandt's model with r = theta (1 + k1 theta^2 + ...); in CamOdoCal its
/// coefficients are called k2 to k5, in ORB-SLAM3 k1 to k4.
Pixel fisheye_pixel(const Intrinsics& k, const std::array<double, 4>& d, const Vector3& p) {
    const double theta = std::atan2(std::hypot(p.x, p.y), p.z), phi = std::atan2(p.y, p.x);
    const double t2 = theta * theta;
    const double r = theta * (1 + t2 * (d[0] + t2 * (d[1] + t2 * (d[2] + t2 * d[3]))));
    return {k.fx * r * std::cos(phi) + k.cx, k.fy * r * std::sin(phi) + k.cy};
}

const std::vector<Vector3> k_points{{0, 0, 1},         {0.1, 0.05, 1},   {-0.3, 0.2, 1},
                                    {0.5, -0.25, 1.1}, {0.02, 0.3, 0.9}, {-0.45, -0.3, 1}};

class RobotFiles : public test::CalibrationReading {
  protected:
    /// That the camera sees points where `pixel_of` does, whose first pixel's centre is at (0, 0);
    /// here it is at (0.5, 0.5).
    void expect_seen(const CameraDesc& desc, const auto& pixel_of) const {
        const Camera camera(desc);
        for (const Vector3& p : k_points) {
            const Pixel pixel = pixel_of(p);
            const auto ray = camera.refracted_ray(pixel.u + 0.5, pixel.v + 0.5);
            ASSERT_TRUE(ray) << p.x << " " << p.y;
            // The lens is inverted by Newton's steps to 1e-12.
            EXPECT_LT(glm::length(ray->direction - glm::normalize(p)), 1e-9) << p.x << " " << p.y;
        }
    }
    void expect_opencv(const std::string& text, const std::string& name, const Intrinsics& k,
                       const std::array<double, 8>& d) const {
        SCOPED_TRACE(name);
        expect_seen(read(text, name).desc, [&](const Vector3& p) { return opencv_pixel(k, d, p); });
    }
    void expect_fisheye(const std::string& text, const std::string& name, const Intrinsics& k,
                        const std::array<double, 4>& d) const {
        SCOPED_TRACE(name);
        expect_seen(read(text, name).desc,
                    [&](const Vector3& p) { return fisheye_pixel(k, d, p); });
    }
};

const Intrinsics k_euroc_k{458.654, 457.296, 367.215, 248.375};
const std::array<double, 8> k_euroc_d{-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};
const Intrinsics k_info_k{522.5, 521.75, 632.25, 362.125};
const std::array<double, 8> k_info_d{-0.17, 0.028, 0.0011, -0.0007, 0.003};

TEST_F(RobotFiles, SeePointsWhereTheirProgramsDo) {
    expect_opencv(k_euroc, "", k_euroc_k, k_euroc_d);
    expect_opencv(k_okvis, "cam0", {458.654880721, 457.296696463, 367.215803962, 248.37534061},
                  {-0.28340811217, 0.0739590738929, 0.000193595028569, 1.76187114545e-05});
    expect_fisheye(k_okvis, "cam1", {190.97847, 190.97330, 254.93170, 256.89744},
                   {0.0034823894, 0.0007150348, -0.0020532361, 0.00020293673});
    expect_opencv(k_orb_slam, "", k_euroc_k, k_euroc_d);
    expect_fisheye(
        k_orb_slam_fisheye, "Camera2",
        {190.44236969414825, 190.4344384721956, 252.59949716835982, 254.91723064636983},
        {0.0034003170790442797, 0.001766278153469831, -0.00266312569781606, 0.0003299517423931039});
    expect_opencv(k_orb_slam_rectified, "LEFT", k_euroc_k, k_euroc_d);
    expect_opencv(k_orb_slam_rectified, "Camera",
                  {435.2046959714599, 435.2046959714599, 367.4517211914062, 252.2008514404297}, {});
    expect_opencv(k_camodocal, "", {461.6, 460.3, 363, 248.1},
                  {-0.2917, 0.08228, 5.333e-05, -1.578e-04});
    expect_fisheye(k_camodocal_fisheye, "", {315, 316, 344, 258}, {-0.012, 0.003, -0.0004, 2e-5});
    expect_opencv(k_matisse, "", {3042.97, 3056.62, 2281.2, 1663.36},
                  {-0.21, 0.07, 0.001, -0.002, 0.0125});
    expect_fisheye(replaced(replaced(k_matisse, "distortion_model: 1", "distortion_model: 3"),
                            "0.0125 ]", "0. ]"),
                   "", {3042.97, 3056.62, 2281.2, 1663.36}, {-0.21, 0.07, 0.001, -0.002});
}

TEST_F(RobotFiles, AreToldByTheirFormats) {
    for (const auto& [text, camera, format, width] :
         {std::tuple(k_camera_info, "", CalibrationFormat::ros, 1280),
          std::tuple(k_euroc, "", CalibrationFormat::euroc, 752),
          std::tuple(k_okvis, "cam0", CalibrationFormat::okvis, 752),
          std::tuple(k_orb_slam, "", CalibrationFormat::orb_slam, 752),
          std::tuple(k_orb_slam_fisheye, "Camera", CalibrationFormat::orb_slam, 512),
          std::tuple(k_camodocal, "", CalibrationFormat::camodocal, 752),
          std::tuple(k_matisse, "", CalibrationFormat::matisse, 4864)}) {
        const Calibration read_back = read(text, camera);
        EXPECT_EQ(read_back.format, format) << title_of(format);
        EXPECT_EQ(read_back.desc.width, width) << title_of(format);
        EXPECT_EQ(read_back.cameras.empty(), read_back.camera.empty());
    }
    EXPECT_EQ(read(k_camera_info).camera, "left_camera_optical_frame");
    EXPECT_EQ(read(k_matisse).camera, "Ulyx Still Camera");
    // The size that ORB-SLAM takes images to is not the camera's.
    EXPECT_EQ(read(k_orb_slam).warnings.size(), 2U);
    expect_refused(k_okvis, "has 2 cameras (cam0, cam1); choose one");
    expect_refused(k_orb_slam_rectified, "has 2 cameras (Camera, LEFT); choose one");
}

// As `ros2 topic echo` prints it, with lines of "---" around it or not, in flow style, and as ROS 1
// printed it, in capitals.
TEST_F(RobotFiles, CameraInfoIsReadAsItIsPrinted) {
    std::string capitals = k_camera_info;
    for (const char* key : {"d:", "k:", "r:", "p:"})
        capitals = replaced(capitals, std::string("\n") + key,
                            std::string("\n") + static_cast<char>(key[0] - 'a' + 'A') + ":");
    const std::string plain = replaced(k_camera_info, "---\n", "");
    const std::string flow = R"(header:
  frame_id: camera
height: 720
width: 1280
distortion_model: plumb_bob
d: [-0.17, 0.028, 0.0011, -0.0007, 0.003]
k: [522.5, 0.0, 632.25, 0.0, 521.75, 362.125, 0.0, 0.0, 1.0]
binning_x: 0
)";
    for (const std::string& text : {k_camera_info, plain, "---\n" + plain, "---\n" + k_camera_info,
                                    k_camera_info + "\n\n", plain + "---", capitals, flow})
        expect_opencv(text, "", k_info_k, k_info_d);
    expect_refused(k_camera_info + k_camera_info, "a second document starts here");
    expect_refused(replaced(replaced(k_camera_info, "522.5", "0.0"), "521.75", "0.0"),
                   "is that of a camera which is not calibrated");
    const std::string none =
        replaced(replaced(k_camera_info, "- -0.17\n- 0.028\n- 0.0011\n- -0.0007\n- 0.003\n", ""),
                 "d:\n", "d: []\n");
    expect_opencv(replaced(none, "plumb_bob", "''"), "", k_info_k, {});
    expect_opencv(none, "", k_info_k, {});
}

// PinholeCameraModel::fromCameraInfo of image_geometry: the offset is taken off the principal
// point, then everything is divided by the binning; the image has roi / binning pixels.
TEST_F(RobotFiles, WindowsAndBinningOfCameraInfoAreHeard) {
    const auto with = [](int bx, int by, int x, int y, int width, int height) {
        std::string text =
            replaced(k_camera_info, "binning_x: 0", fmt::format("binning_x: {}", bx));
        text = replaced(text, "binning_y: 0", fmt::format("binning_y: {}", by));
        text = replaced(text, "x_offset: 0", fmt::format("x_offset: {}", x));
        text = replaced(text, "y_offset: 0", fmt::format("y_offset: {}", y));
        text = replaced(text, "  height: 0", fmt::format("  height: {}", height));
        return replaced(text, "  width: 0", fmt::format("  width: {}", width));
    };
    for (const auto& [bx, by, x, y, width, height] :
         {std::tuple(1, 1, 0, 0, 0, 0), std::tuple(0, 0, 0, 0, 1280, 720),
          std::tuple(2, 2, 0, 0, 0, 0), std::tuple(1, 1, 320, 100, 640, 480),
          std::tuple(2, 4, 320, 100, 640, 480), std::tuple(3, 1, 0, 8, 1279, 700)}) {
        SCOPED_TRACE(fmt::format("{} {} {} {} {} {}", bx, by, x, y, width, height));
        const std::string text = with(bx, by, x, y, width, height);
        const int across = std::max(bx, 1), down = std::max(by, 1);
        expect_opencv(text, "",
                      {522.5 / across, 521.75 / down, (632.25 - x) / across, (362.125 - y) / down},
                      k_info_d);
        const CameraDesc desc = read(text).desc;
        EXPECT_EQ(desc.width, (width > 0 ? width : 1280) / across);
        EXPECT_EQ(desc.height, (height > 0 ? height : 720) / down);
    }
    expect_refused(with(1, 1, 700, 0, 640, 480),
                   "roi: 640 x 480 pixels at (700, 0) are no part of");
    expect_refused(with(1, 1, 10, 0, 0, 0), "are no part of the image");
    expect_refused(with(1000, 1, 0, 0, 640, 480), "its binning leaves no pixel");
    expect_refused(with(-2, 1, 0, 0, 0, 0), "binning_x: must be from 0");
}

// Zeros for what a model does not have are no model; anything else is named.
TEST_F(RobotFiles, SurplusCoefficientsMayBeZero) {
    const auto with = [](const std::string& model, const std::vector<double>& d) {
        std::string list = "d:\n";
        for (const double c : d) list += fmt::format("- {}\n", c);
        return replaced(replaced(k_camera_info, "plumb_bob", model),
                        "d:\n- -0.17\n- 0.028\n- 0.0011\n- -0.0007\n- 0.003\n", list);
    };
    const std::vector<double> rational{0.17, 0.028, 0.0011, -0.0007, 0.003, 0.3, 0.05, 0.002};
    const std::array<double, 8> same{0.17, 0.028, 0.0011, -0.0007, 0.003, 0.3, 0.05, 0.002};
    const std::vector<double> fisheye{-0.012, 0.003, -0.0004, 2e-5};
    const std::array<double, 4> same_fisheye{-0.012, 0.003, -0.0004, 2e-5};
    const auto padded = [](std::vector<double> d, std::size_t count) {
        d.resize(count);
        return d;
    };
    for (const std::size_t count : {8U, 12U, 14U})
        expect_opencv(with("rational_polynomial", padded(rational, count)), "", k_info_k, same);
    for (const std::size_t count : {4U, 5U, 8U})
        expect_fisheye(with("equidistant", padded(fisheye, count)), "", k_info_k, same_fisheye);
    for (const std::size_t count : {5U, 8U, 12U})
        expect_opencv(with("plumb_bob", padded({-0.17, 0.028, 0.0011, -0.0007, 0.003}, count)), "",
                      k_info_k, k_info_d);
    std::vector<double> thin = padded(rational, 12);
    thin[9] = 1e-4;
    expect_refused(with("rational_polynomial", thin), "d: has a thin-prism coefficient (0.0001)");
    std::vector<double> tilted = padded(rational, 14);
    tilted[13] = 0.01;
    expect_refused(with("rational_polynomial", tilted), "d: has a sensor tilt (0.01)");
    std::vector<double> fifth = padded(fisheye, 5);
    fifth[4] = 1e-4;
    expect_refused(with("equidistant", fifth), "d: has a coefficient beyond k1 to k4 (0.0001)");
    expect_refused(with("plumb_bob", rational), "write distortion_model: rational_polynomial");
    expect_refused(with("rational_polynomial", {1, 2, 3}), "expected 8 numbers, found 3");
    expect_refused(with("equidistant", {1, 2, 3}), "expected 4 numbers, found 3");
}

TEST_F(RobotFiles, APrincipalPointOutsideTheImageIsWarnedOf) {
    for (const auto& [text, camera, from, to] :
         {std::tuple(k_camera_info, "", "632.25", "1632.25"),
          std::tuple(k_euroc, "", "367.215", "-3"),
          std::tuple(k_okvis, "cam0", "367.215803962", "760"),
          std::tuple(k_camodocal, "", "3.630e+02", "9e2"),
          std::tuple(k_matisse, "", "2.2811999999999998e+03", "-2")}) {
        const auto warnings = read(replaced(text, from, to), camera).warnings;
        ASSERT_EQ(warnings.size(), 1U);
        EXPECT_NE(warnings[0].find("lies outside the image of"), std::string::npos) << warnings[0];
        EXPECT_TRUE(read(text, camera).warnings.empty());
    }
}

TEST_F(RobotFiles, WhatTheyCannotSayIsRefusedByItsName) {
    expect_refused(replaced(k_euroc, "camera_model: pinhole", "camera_model: omni"),
                   "the camera model omni is not supported; calibrate with pinhole");
    expect_refused("sensor_type: imu\nrate_hz: 200\n", "is of the sensor 'imu', not of a camera");
    expect_refused(replaced(k_euroc, "resolution: [752, 480]\n", ""), "'resolution' is missing");
    expect_refused(replaced(k_okvis, "distortion_type: equidistant", "distortion_type: eucm"),
                   "the camera model eucm is not supported; calibrate with radialtangential,",
                   "cam1");
    expect_refused(replaced(k_orb_slam, "\"PinHole\"", "\"MEI\""),
                   "Camera.type: the camera model MEI is not supported; calibrate with PinHole");
    expect_refused(replaced(k_orb_slam, "Camera.width: 752\n", ""), "'Camera.width' is missing");
    expect_refused(replaced(k_orb_slam, "Camera1.cy: 248.375\n", ""), "'Camera1.cy' is missing");
    for (const char* model : {"MEI", "SCARAMUZZA", "PINHOLE_FULL"})
        expect_refused(replaced(k_camodocal, "PINHOLE", model),
                       std::string("the camera model ") + model +
                           " is not supported; calibrate "
                           "with PINHOLE or KANNALA_BRANDT");
    expect_refused(replaced(k_camodocal, "   k2: 8.228e-02\n", ""), "'k2' is missing");
    expect_refused(replaced(k_matisse, "distortion_model: 1", "distortion_model: 7"),
                   "distortion_model: must be from 0 to 3");
    expect_refused(
        replaced(replaced(k_matisse, "cols: 5", "cols: 3"),
                 "data: [ -0.21, 0.07, 0.001, -0.002, 0.0125 ]", "data: [ -0.21, 0.07, 0.001 ]"),
        "expected 5 numbers, found 3");
    expect_refused("some words\n\n#pinax\nand 0.5\n", "a calibration as lines of 'key: value'");
    expect_refused(
        "#camodocal params\nx_corners 8\ncamera_model kannala-brandt\n\n#pinax params\n"
        "d_cam2panel 0.0028\nglass_thickness 0.02\nn_glass 1.7751\nn_water 1.34\nEND\n",
        "has the port of Pinax, and no camera; name CamOdoCal's camera_left.yaml");
}

}  // namespace
}  // namespace uw
