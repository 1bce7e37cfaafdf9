// ctest labels: unit
#include <gtest/gtest.h>

#include "camera/calibration.h"
#include "tests/support/calibration_reading.h"
#include "tests/support/calibration_texts.h"

namespace uw {
namespace {

class ColmapCameras : public test::CalibrationReading {};

TEST_F(ColmapCameras, NamesTheCameraRead) {
    EXPECT_EQ(read("7 PINHOLE 640 480 500 500 320 240\n").camera, "7");
    for (const char* name : {"2", "12", "21"}) EXPECT_EQ(read(test::k_colmap, name).camera, name);
}

TEST_F(ColmapCameras, RefusesInOneLine) {
    expect_refused(test::k_colmap, "has 5 cameras (1, 2, 12, 20, 21); choose one");
    expect_refused(test::k_colmap, "has no camera '3'", "3");
    expect_refused("1 OPENCV 640 480 500 500 320\n",
                   "c.yaml:1:3: MODEL: OPENCV has 8 parameters (fx fy cx cy k1 k2 p1 p2), found 3");
    expect_refused("1 PINHOLE 640 480 500 500 320 240 7\n", "PINHOLE has 4 parameters");
    expect_refused("1 PINHOLE 640 480 5OO 500 320 240\n",
                   "c.yaml:1:19: PARAMS[0]: expected a number");
    expect_refused("1 PINHOLE 640 480 nan 500 320 240\n", "PARAMS[0]");
    expect_refused("1 PINHOLE 0 480 500 500 320 240\n", "WIDTH: must be from 1");
    expect_refused("1 PINHOLE 640 1e99 500 500 320 240\n", "HEIGHT");
    expect_refused("1 THIN_PRISM_FISHEYE 640 480 1 1 1 1 0 0 0 0 0 0 0 0\n",
                   "THIN_PRISM_FISHEYE is not supported");
    expect_refused("1 PINHOLL 640 480 500 500 320 240\n", "did you mean 'PINHOLE'?");
    expect_refused("1 PINHOLE 640 480 500 500 320 240 FLATPORT 0 0 1\n",
                   "FLATPORT has 8 parameters");
    expect_refused("1 PINHOLE 640 480 500 500 320 240 FLUTPORT 0 0 1 1 1 1 1 1\n",
                   "did you mean 'FLATPORT'?");
    expect_refused("1 PINHOLE 640 480 500 500 320 FLATPORT 0 0 1 0.02 0.007 1 1.49 1.334\n",
                   "PINHOLE has 4 parameters");
    std::string endless = "1 PINHOLE 640 480";
    for (int i = 0; i < 100000; ++i) endless += " 1";
    expect_refused(endless, "is not a COLMAP camera");
    std::string many;
    for (int i = 0; i < 100000; ++i)
        many += std::to_string(i) + " PINHOLE 640 480 500 500 320 240\n";
    expect_refused(many, "has 100000 cameras (0, 1, 2, 3, 4, 5, 6, 7, ...)");
}

TEST_F(ColmapCameras, HasALineForStockColmapToo) {
    const std::string text =
        write_calibration(CalibrationFormat::colmap, read(test::k_colmap, "20").desc);
    EXPECT_NE(text.find("\n1 PINHOLE 1920 1080 1400 1401 961 541 FLATPORT 0 0 1 0.02 0.007 1 1.49 "
                        "1.334\n"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("\n# 1 PINHOLE 1920 1080 1400 1401 961 541\n"), std::string::npos) << text;
}

TEST_F(ColmapCameras, AreLinesThatBeginWithANumberAndAModel) {
    EXPECT_TRUE(looks_like_colmap(test::k_colmap));
    EXPECT_TRUE(looks_like_colmap("\n  # comment\n\n7 PINHOLE 1 1 1\n"));
    for (const char* text : {"", "# nothing\n", "PINHOLE 1 1 1\n", "1 pinhole 1 1\n", "1 PINHOLE\n",
                             "cam0:\n  camera_model: pinhole\n"})
        EXPECT_FALSE(looks_like_colmap(text)) << text;
}

TEST_F(ColmapCameras, LinesMayEndAsOnWindows) {
    const CameraDesc camera = read("1 PINHOLE 640 480 500 510 320 240\r\n").desc;
    EXPECT_EQ(camera.intrinsics.cy, 240);
    EXPECT_EQ(camera.intrinsics.fy, 510);
}

}  // namespace
}  // namespace uw
