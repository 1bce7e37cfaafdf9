// ctest labels: unit
#include <gtest/gtest.h>

#include <fstream>

#include "camera/calibration/calibration.h"
#include "core/base/error.h"
#include "tests/support/calibration_texts.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

class CalibrationErrors : public testing::Test {
  protected:
    std::string error_of(const std::string& text, const std::string& camera = "") const {
        std::ofstream(folder_ / "c.yaml", std::ios::binary) << text;
        try {
            read_calibration(folder_ / "c.yaml", camera);
        } catch (const InputError& error) {
            return error.what();
        }
        return "no InputError";
    }
    void expect(const std::string& text, const std::string& part,
                const std::string& camera = "") const {
        const std::string found = error_of(text, camera);
        EXPECT_NE(found.find(part), std::string::npos)
            << text << "\n  gave:     " << found << "\n  expected: " << part;
        EXPECT_EQ(found.find('\n'), std::string::npos) << "one line: " << found;
    }
    test::TempDir folder_;
};

/// `text` with its first `from` as `to`.
std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST_F(CalibrationErrors, UnknownFilesListWhatIsKnown) {
    for (const char* text : {"", " \n", "a: 1\n", "[1, 2]\n", "hello\n", "a: {b: c}\n"})
        expect(text, "known are OpenCV and ROS YAML");
    expect("uwvdb: 1\ncamera: {}\n", "is a scene and no calibration");
    expect(std::string("\0\1\2", 3), "not UTF-8 text");
    expect("a: [1\n", "mend the YAML");
    expect("model: !!python/object x\nparameters: []\n", "has no meaning in a calibration");
}

TEST_F(CalibrationErrors, OpenCv) {
    const std::string& ros = test::k_ros_plumb_bob;
    expect(with(ros, "image_width: 640\n", ""), "'image_width' is missing");
    expect(with(ros, "image_width: 640", "image_width: -640"), "image_width: must be from 1");
    expect(with(ros, "image_width: 640", "image_width: 1e9"), "image_width: must be from 1");
    expect(with(ros, "image_width: 640", "image_width: wide"), "image_width: expected a number");
    expect(with(ros, "526.6908296825479, 0,", "526.6908296825479, 0.5,"),
           "skewed pixels are not supported");
    expect(with(ros, "526.6908296825479", "-526"), "camera_matrix.data[0]: must be greater than 0");
    expect(with(ros, "526.6908296825479", ".nan"), "is not a finite number");
    expect(with(ros, "526.6908296825479", "1e300"), "is larger than anything");
    expect(with(ros, "0, 0, 1]", "0, 0]"), "rows x cols are 9, but data has 8 numbers");
    expect(with(ros, "cols: 3", "cols: 1000000000"), "must be from 0 to 64");
    expect(with(ros, "plumb_bob", "plum_bob"), "did you mean 'plumb_bob'?");
    expect(with(ros, "plumb_bob", "equidistant"), "expected 4 numbers, found 5");
    expect(with(ros, "plumb_bob", "rational_polynomial"), "expected 8 numbers, found 5");
    expect(with(ros,
                "  data: [0.01864117263397289, -0.0807953154457166, 0.0006701578887838996, "
                "-0.001800282263098739, 0]\n",
                ""),
           "'data' is missing");
    expect(with(ros, "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [526.6908296825479, 0,",
                "camera_matrix:\n  data: ["),
           "camera_matrix: expected 9 numbers, found 7");
    const std::string thin =
        with(with(ros, "plumb_bob", "rational_polynomial"), "cols: 5\n  data: [0.0186411726",
             "cols: 12\n  data: [0, 0, 0, 0, 0, 0, 0.1, 0.0186411726");
    expect(with(thin, "distortion_model: rational_polynomial\n", ""),
           "has a thin-prism coefficient");
    expect(ros, "has one camera, 'rgb_camera', and none called 'cam0'", "cam0");
}

TEST_F(CalibrationErrors, Kalibr) {
    expect(test::k_kalibr, "has 2 cameras (cam0, cam1); choose one");
    expect(test::k_kalibr, "has no camera 'cam2'; it has cam0, cam1", "cam2");
    for (const char* model : {"omni", "ds", "eucm"})
        expect(with(test::k_kalibr, "pinhole", model),
               std::string("the camera model ") + model + " is not supported; calibrate with",
               "cam0");
    expect(with(test::k_kalibr, "pinhole", "lens"), "unknown camera model 'lens'", "cam0");
    expect(with(test::k_kalibr, "radtan", "fov"), "fov is not supported", "cam0");
    expect(with(test::k_kalibr, "radtan", "tanrad"), "unknown value 'tanrad'", "cam0");
    expect(with(test::k_kalibr, "[752, 480]", "[752]"), "cam0.resolution: expected a list of 2",
           "cam0");
    expect(with(test::k_kalibr, "[461.629, ", "["), "cam0.intrinsics: expected a list of 4",
           "cam0");
    expect(with(test::k_kalibr, "461.629", "[1]"), "cam0.intrinsics[0]: expected a number", "cam0");
    expect(with(test::k_kalibr, "[-0.27695497, ", "["),
           "cam0.distortion_coeffs: expected a list of 4", "cam0");
}

TEST_F(CalibrationErrors, Calibmar) {
    const std::string& flat = test::k_calibmar_flat;
    expect(with(flat, "model: OPENCV\n", ""), "'model' is missing");
    expect(with(flat, "width: 1920\n", ""), "'width' is missing");
    expect(with(flat, "OPENCV", "OPENCW"), "did you mean 'OPENCV'?");
    expect(with(flat, "OPENCV", "FOV"), "the camera model FOV is not supported; calibrate with");
    expect(with(flat, "[705.391983, ", "["), "OPENCV has 8 parameters (fx fy cx cy k1 k2 p1 p2)");
    expect(with(flat, "705.391983", "0"), "parameters[0]: must be greater than 0");
    expect(with(flat, "FLATPORT", "FLATPORD"), "did you mean 'FLATPORT'?");
    expect(with(flat, ", 1.333]", "]"), "FLATPORT has 8 parameters");
    expect(with(flat, "1.333]", "13.33]"), "must be from 1 to 3, found 13.33");
    expect(with(flat, "0.9999040533", "0.5"), "has length 0.5");
    expect(with(flat, "0.9999040533", "-0.9999040533"), "must point away from the camera");
    expect(with(flat, "0.02531637365", "-0.1"), "must not be negative, found -0.1");
    const std::string& dome = test::k_calibmar_dome;
    expect(with(dome, "0.0087,", "0.0587,"), "the camera stands outside of its dome");
    expect(with(dome, "0.05, ", "0, "), "must be greater than 0, found 0");
    expect(with(dome, "DOMEPORT", "[DOMEPORT]"), "expected a text, found a list of 1");
}

TEST_F(CalibrationErrors, Colmap) {
    expect(test::k_colmap, "has 5 cameras (1, 2, 12, 20, 21); choose one");
    expect(test::k_colmap, "has no camera '3'", "3");
    expect("1 OPENCV 640 480 500 500 320\n",
           "c.yaml:1:3: MODEL: OPENCV has 8 parameters (fx fy cx cy k1 k2 p1 p2), found 3");
    expect("1 PINHOLE 640 480 500 500 320 240 7\n", "PINHOLE has 4 parameters");
    expect("1 PINHOLE 640 480 5OO 500 320 240\n", "c.yaml:1:19: PARAMS[0]: expected a number");
    expect("1 PINHOLE 640 480 nan 500 320 240\n", "PARAMS[0]");
    expect("1 PINHOLE 0 480 500 500 320 240\n", "WIDTH: must be from 1");
    expect("1 PINHOLE 640 1e99 500 500 320 240\n", "HEIGHT");
    expect("1 THIN_PRISM_FISHEYE 640 480 1 1 1 1 0 0 0 0 0 0 0 0\n",
           "THIN_PRISM_FISHEYE is not supported");
    expect("1 PINHOLL 640 480 500 500 320 240\n", "did you mean 'PINHOLE'?");
    expect("1 PINHOLE 640 480 500 500 320 240 FLATPORT 0 0 1\n", "FLATPORT has 8 parameters");
    expect("1 PINHOLE 640 480 500 500 320 240 FLUTPORT 0 0 1 1 1 1 1 1\n",
           "did you mean 'FLATPORT'?");
    expect("1 PINHOLE 640 480 500 500 320 FLATPORT 0 0 1 0.02 0.007 1 1.49 1.334\n",
           "PINHOLE has 4 parameters");
    std::string endless = "1 PINHOLE 640 480";
    for (int i = 0; i < 100000; ++i) endless += " 1";
    expect(endless, "is no camera of COLMAP");
    std::string many;
    for (int i = 0; i < 100000; ++i)
        many += std::to_string(i) + " PINHOLE 640 480 500 500 320 240\n";
    expect(many, "has 100000 cameras (0, 1, 2, 3, 4, 5, 6, 7, ...)");
}

TEST_F(CalibrationErrors, WhatIsNoFile) {
    EXPECT_THROW(read_calibration(folder_ / "none.yaml"), IoError);
    EXPECT_THROW(read_calibration(folder_.path()), IoError);
}

}  // namespace
}  // namespace uw
