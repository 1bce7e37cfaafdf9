#pragma once

#include <string>
#include <utility>
#include <vector>

namespace uw::test {

/// Files as their programs write them, a name and a text each; the last part of the name is the
/// camera to choose.
struct CalibrationText {
    std::string name, camera, text;
};

inline const std::string k_ros_plumb_bob = R"(image_width: 640
image_height: 480
camera_name: rgb_camera
camera_matrix:
  rows: 3
  cols: 3
  data: [526.6908296825479, 0, 312.3333507245396, 0, 525.7542623070541, 246.2279496394374, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.01864117263397289, -0.0807953154457166, 0.0006701578887838996, -0.001800282263098739, 0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  data: [516.2001953125, 0, 310.3634868958034, 0, 0, 514.0494995117188, 246.8852026000968, 0, 0, 0, 1, 0]
)";

inline const std::string k_opencv_rational = R"(%YAML:1.0
---
calibration_time: "Fri Nov 20 10:00:00 2026"
image_width: 1280
image_height: 720
flags: 16384
fisheye_model: 0
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 9.1000000000000000e+02, 0., 6.3950000000000000e+02, 0.,
       9.1200000000000000e+02, 3.5950000000000000e+02, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 8
   cols: 1
   dt: d
   data: [ 5.2000000000000002e+00, 3.1000000000000001e+00,
       1.0000000000000000e-04, -2.0000000000000001e-04,
       1.4999999999999999e-01, 5.5000000000000000e+00, 4.9000000000000004e+00, 9.0000000000000002e-01 ]
avg_reprojection_error: 2.1000000000000000e-01
)";

inline const std::string k_kalibr = R"(cam0:
  camera_model: pinhole
  intrinsics: [461.629, 460.152, 362.680, 246.049]
  distortion_model: radtan
  distortion_coeffs: [-0.27695497, 0.06712482, 0.00087538, 0.00011556]
  T_cam_imu:
  - [0.01779318, 0.99967549,-0.01822936, 0.07008565]
  - [-0.9998017, 0.01795239, 0.00860714,-0.01771023]
  - [0.00893160, 0.01807260, 0.99979678, 0.00399246]
  - [0.0, 0.0, 0.0, 1.0]
  timeshift_cam_imu: -8.121e-05
  rostopic: /cam0/image_raw
  resolution: [752, 480]
cam1:
  camera_model: pinhole
  intrinsics: [190.97847715128717, 190.9733070521226, 254.93170605935475, 256.8974428996504]
  distortion_model: equidistant
  distortion_coeffs: [0.0034823894022493434, 0.0007150348452162257, -0.0020532361418706202, 0.00020293673591811182]
  T_cn_cnm1:
  - [1, 0, 0, -0.1]
  - [0, 1, 0, 0]
  - [0, 0, 1, 0]
  - [0, 0, 0, 1]
  rostopic: /cam1/image_raw
  resolution: [512, 512]
)";

inline const std::string k_calibmar_flat = R"(model: OPENCV
# fx, fy, cx, cy, k1, k2, p1, p2
parameters: [705.391983, 705.210233, 963.440447, 604.968632, -0.105541, 0.066014, 0.001093, -8.6e-05]
non_svp_model: FLATPORT
# Nx, Ny, Nz, int_dist, int_thick, na, ng, nw (Note that [Nx, Ny, Nz] must be unit vector)
non_svp_parameters: [0.01311427226, -0.004460945556, 0.9999040533, 0.02531637365, 0.01, 1, 1.49, 1.333]
# non_svp_est_std_dev: 0.001294740237, 0.001435687642, 1.84569193e-05, 0.0005963799373, 0, 0, 0, 0
width: 1920
height: 1200
# overall_rms: 0.8004862862
# target: chessboard, 7, 8, 0.040000
)";

inline const std::string k_calibmar_dome = R"(model: OPENCV_FISHEYE
parameters: [512.5, 511.25, 640.5, 480.25, 0.02, -0.004, 0.001, -0.0002]
non_svp_model: DOMEPORT
non_svp_parameters: [0.0012, -0.0034, 0.0087, 0.05, 0.007, 1, 1.473, 1.334]
width: 1280
height: 960
)";

inline const std::string k_colmap = R"(# Camera list with one line of data per camera:
#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]
# Number of cameras: 4
1 SIMPLE_RADIAL 3072 2304 2559.81 1536 1152 -0.0204997
2 PINHOLE 1920 1080 1400.5 1399.5 960 540
12 FULL_OPENCV 1920 1080 1400.5 1399.5 960 540 -0.1 0.05 0.001 -0.002 0.01 0.02 -0.003 0.0004
20 PINHOLE 1920 1080 1400 1401 961 541 FLATPORT 0 0 1 0.02 0.007 1 1.49 1.334
21 RADIAL_FISHEYE 1000 1000 300 500 500 0.01 -0.001 DOMEPORT 0.001 0.002 0.01 0.05 0.007 1 1.52 1.334
)";

inline std::vector<CalibrationText> calibration_texts() {
    return {{"ROS plumb_bob", "", k_ros_plumb_bob},  {"OpenCV rational", "", k_opencv_rational},
            {"Kalibr radtan", "cam0", k_kalibr},     {"Kalibr equidistant", "cam1", k_kalibr},
            {"Calibmar flat", "", k_calibmar_flat},  {"Calibmar dome", "", k_calibmar_dome},
            {"COLMAP SIMPLE_RADIAL", "1", k_colmap}, {"COLMAP PINHOLE", "2", k_colmap},
            {"COLMAP FULL_OPENCV", "12", k_colmap},  {"COLMAP flat", "20", k_colmap},
            {"COLMAP dome", "21", k_colmap}};
}

}  // namespace uw::test
