// ctest labels: unit
#include <gtest/gtest.h>

#include "camera/calibration.h"
#include "tests/support/calibration_reading.h"
#include "tests/support/calibration_texts.h"

namespace uw {
namespace {

using test::replaced;

class KalibrCamchain : public test::CalibrationReading {};

TEST_F(KalibrCamchain, RefusesInOneLine) {
    expect_refused(test::k_kalibr, "has 2 cameras (cam0, cam1); choose one");
    expect_refused(test::k_kalibr, "has no camera 'cam2'; it has cam0, cam1", "cam2");
    for (const char* model : {"omni", "ds", "eucm"})
        expect_refused(
            replaced(test::k_kalibr, "pinhole", model),
            std::string("the camera model ") + model + " is not supported; calibrate with", "cam0");
    expect_refused(replaced(test::k_kalibr, "pinhole", "lens"), "unknown camera model 'lens'",
                   "cam0");
    expect_refused(replaced(test::k_kalibr, "radtan", "fov"), "fov is not supported", "cam0");
    expect_refused(replaced(test::k_kalibr, "radtan", "tanrad"), "unknown value 'tanrad'", "cam0");
    expect_refused(replaced(test::k_kalibr, "[752, 480]", "[752]"),
                   "cam0.resolution: expected a list of 2", "cam0");
    expect_refused(replaced(test::k_kalibr, "[461.629, ", "["),
                   "cam0.intrinsics: expected a list of 4", "cam0");
    expect_refused(replaced(test::k_kalibr, "461.629", "[1]"),
                   "cam0.intrinsics[0]: expected a number", "cam0");
    expect_refused(replaced(test::k_kalibr, "[-0.27695497, ", "["),
                   "cam0.distortion_coeffs: expected a list of 4", "cam0");
}

TEST_F(KalibrCamchain, HasACameraForEachEntry) {
    const Calibration first = read(test::k_kalibr, "cam0");
    EXPECT_EQ(first.cameras, (std::vector<std::string>{"cam0", "cam1"}));
    EXPECT_EQ(first.model, "pinhole, radtan");
    EXPECT_EQ(first.desc.width, 752);
    EXPECT_EQ(first.desc.intrinsics.cx, 362.680 + 0.5);  // pixel centres are at 0 in the file
    EXPECT_EQ(first.desc.distortion.k[1], 0.06712482);
    EXPECT_EQ(first.desc.distortion.p, (std::array<double, 2>{0.00087538, 0.00011556}));
    const Calibration second = read(test::k_kalibr, "cam1");
    EXPECT_EQ(second.model, "pinhole, equidistant");
    EXPECT_EQ(second.desc.distortion.model, DistortionDesc::Model::fisheye);
}

TEST_F(KalibrCamchain, WithoutDistortionNeedsNoCoefficients) {
    const Calibration none = read(
        "cam0: {camera_model: pinhole, intrinsics: [100, 101, 49.5, 39.5], distortion_model: none, "
        "resolution: [100, 80]}\n");
    EXPECT_FALSE(is_distorted(none.desc.distortion));
    EXPECT_EQ(none.desc.intrinsics.cx, 50);
}

TEST_F(KalibrCamchain, WritesWhatItReads) {
    const CameraDesc camera = read(test::k_kalibr, "cam1").desc;
    const CameraDesc again = read(write_kalibr(camera)).desc;
    EXPECT_EQ(again.distortion.k, camera.distortion.k);
    EXPECT_EQ(again.intrinsics.fy, camera.intrinsics.fy);
    EXPECT_EQ(again.intrinsics.cy, camera.intrinsics.cy);
    EXPECT_EQ(again.height, 512);
}

TEST_F(KalibrCamchain, SaysWhatItHasNoWordFor) {
    CameraDesc camera = read(test::k_kalibr, "cam0").desc;
    EXPECT_EQ(kalibr_obstacle(camera), "");
    camera.distortion.k[2] = 0.01;
    EXPECT_NE(kalibr_obstacle(camera).find("radtan has only k1, k2, p1 and p2"), std::string::npos);
    camera.distortion.model = DistortionDesc::Model::fisheye;
    EXPECT_EQ(kalibr_obstacle(camera), "");
    camera.port = DomePortDesc();
    EXPECT_NE(kalibr_obstacle(camera).find("have no ports"), std::string::npos);
}

}  // namespace
}  // namespace uw
