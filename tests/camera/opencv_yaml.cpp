// ctest labels: unit
#include <gtest/gtest.h>

#include "camera/calibration.h"
#include "core/scene/yaml_document.h"
#include "tests/support/calibration_reading.h"
#include "tests/support/calibration_texts.h"

namespace uw {
namespace {

using test::replaced;

class OpencvYaml : public test::CalibrationReading {};

TEST_F(OpencvYaml, RefusesEachCoefficientThatItHasNoModelFor) {
    const std::string plain = replaced(test::k_ros_plumb_bob, "distortion_model: plumb_bob\n", "");
    for (int which = 8; which < 14; ++which) {
        std::string numbers = "cols: 14\n  data: [0";
        for (int i = 1; i < 14; ++i) numbers += i == which ? ", 0.1" : ", 0";
        const std::string data =
            "cols: 5\n  data: [0.01864117263397289, -0.0807953154457166, 0.0006701578887838996, "
            "-0.001800282263098739, 0";
        expect_refused(replaced(plain, data, numbers),
                       which < 12 ? "has a thin-prism coefficient" : "has a sensor tilt");
    }
}

TEST_F(OpencvYaml, RefusesInOneLine) {
    const std::string& ros = test::k_ros_plumb_bob;
    expect_refused(replaced(ros, "image_width: 640\n", ""), "'image_width' is missing");
    expect_refused(replaced(ros, "image_width: 640", "image_width: -640"),
                   "image_width: must be from 1");
    expect_refused(replaced(ros, "image_width: 640", "image_width: 1e9"),
                   "image_width: must be from 1");
    expect_refused(replaced(ros, "image_width: 640", "image_width: wide"),
                   "image_width: expected a number");
    expect_refused(replaced(ros, "526.6908296825479, 0,", "526.6908296825479, 0.5,"),
                   "skewed pixels are not supported");
    expect_refused(replaced(ros, "526.6908296825479", "-526"),
                   "camera_matrix.data[0]: must be greater than 0");
    expect_refused(replaced(ros, "526.6908296825479", ".nan"), "is not a finite number");
    expect_refused(replaced(ros, "526.6908296825479", "1e300"), "is larger than anything");
    expect_refused(replaced(ros, "0, 0, 1]", "0, 0]"), "rows x cols is 9, but data has 8 numbers");
    expect_refused(replaced(ros, "cols: 3", "cols: 1000000000"), "must be from 0 to 64");
    expect_refused(replaced(ros, "plumb_bob", "plum_bob"), "did you mean 'plumb_bob'?");
    expect_refused(replaced(replaced(ros, "plumb_bob", "equidistant"), "-0.001800282263098739, 0]",
                            "-0.001800282263098739, 0.1]"),
                   "has a coefficient beyond k1 to k4 (0.1)");
    expect_refused(replaced(ros, "plumb_bob", "rational_polynomial"),
                   "expected 8 numbers, found 5");
    expect_refused(
        replaced(ros,
                 "  data: [0.01864117263397289, -0.0807953154457166, 0.0006701578887838996, "
                 "-0.001800282263098739, 0]\n",
                 ""),
        "'data' is missing");
    expect_refused(
        replaced(ros, "camera_matrix:\n  rows: 3\n  cols: 3\n  data: [526.6908296825479, 0,",
                 "camera_matrix:\n  data: ["),
        "camera_matrix: expected 9 numbers, found 7");
    const std::string thin = replaced(replaced(ros, "plumb_bob", "rational_polynomial"),
                                      "cols: 5\n  data: [0.0186411726",
                                      "cols: 12\n  data: [0, 0, 0, 0, 0, 0, 0.1, 0.0186411726");
    expect_refused(replaced(thin, "distortion_model: rational_polynomial\n", ""),
                   "has a thin-prism coefficient");
    expect_refused(ros, "has one camera, 'rgb_camera', and none called 'cam0'", "cam0");
}

TEST_F(OpencvYaml, LooksLikeItselfAlone) {
    for (const auto& [text, is_opencv] : {std::pair(test::k_ros_plumb_bob, true),
                                          {test::k_kalibr, false},
                                          {test::k_calibmar_flat, false}})
        EXPECT_EQ(looks_like_opencv(parse_yaml(text, "c.yaml")), is_opencv) << text;
}

TEST_F(OpencvYaml, FourUnnamedCoefficientsAreBrownConradyWithAWarning) {
    const Calibration read_back = read(R"(%YAML:1.0
image_width: 100
image_height: 80
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 100., 0., 50., 0., 100., 40., 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 4
   cols: 1
   dt: d
   data: [ 0.1, 0.2, 0.3, 0.4 ]
)");
    EXPECT_EQ(read_back.desc.distortion.p, (std::array<double, 2>{0.3, 0.4}));
    ASSERT_EQ(read_back.warnings.size(), 1U);
    EXPECT_NE(read_back.warnings[0].find("cv::fisheye"), std::string::npos);
}

TEST_F(OpencvYaml, PixelCentresGoFromZeroToHalfAndBack) {
    const CameraDesc camera = read(test::k_ros_plumb_bob).desc;
    EXPECT_EQ(camera.intrinsics.cx, 312.3333507245396 + 0.5);
    EXPECT_EQ(camera.intrinsics.fx, 526.6908296825479);
    EXPECT_EQ(camera.distortion.k[1], -0.0807953154457166);
    EXPECT_EQ(camera.distortion.p[0], 0.0006701578887838996);
    for (const std::string& text : {write_opencv(camera), write_ros(camera)})
        EXPECT_NE(text.find("312.3333507245396"), std::string::npos) << text;
}

TEST_F(OpencvYaml, HasNoWordForPorts) {
    CameraDesc camera = read(test::k_ros_plumb_bob).desc;
    EXPECT_EQ(opencv_obstacle(camera), "");
    camera.port = FlatPortDesc();
    EXPECT_NE(opencv_obstacle(camera).find("have no ports"), std::string::npos);
}

}  // namespace
}  // namespace uw
