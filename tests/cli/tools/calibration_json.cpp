// ctest labels: unit
#include "cli/tools/calibration_command.h"

#include <gtest/gtest.h>

#include "core/base/json.h"

namespace uw {
namespace {

Calibration odd_calibration() {
    Calibration calibration;
    calibration.format = CalibrationFormat::kalibr;
    calibration.camera = "cam\xff";
    calibration.cameras = {"cam0", "cam1"};
    calibration.desc.width = 640;
    calibration.desc.height = 480;
    calibration.desc.intrinsics = {1000.0 / 3, 300, 320, 240};
    calibration.desc.distortion.k[1] = 0.1;
    return calibration;
}

Json json_of_calibration(const Calibration& calibration) {
    return Json::parse(report_on_calibration(survey_calibration("c.yaml", calibration)).json());
}

TEST(CalibrationJson, HasAllDigitsOfTheCamera) {
    const Json json = json_of_calibration(odd_calibration());
    EXPECT_EQ(json.at("format"), "kalibr");
    EXPECT_EQ(json.at("resolution"), Json({640, 480}));
    EXPECT_EQ(json.at("intrinsics").at("fx").get<double>(), 1000.0 / 3);
    EXPECT_EQ(json.at("distortion").at("model"), "brown-conrady");
    EXPECT_EQ(json.at("distortion").at("k"), Json({0.0, 0.1, 0.0, 0.0, 0.0, 0.0}));
    EXPECT_TRUE(json.at("port").is_null());
    EXPECT_TRUE(json.at("fold_angle").is_null());
    EXPECT_EQ(json.at("camera"), "cam\xEF\xBF\xBD");
    EXPECT_EQ(json.at("cameras"), Json({"cam0", "cam1"}));
}

TEST(CalibrationJson, AnglesAreDegrees) {
    Calibration square = odd_calibration();
    square.desc.intrinsics = {320, 240, 320, 240};
    square.desc.distortion = {};
    const Json field = json_of_calibration(square).at("field_of_view_in_housing");
    EXPECT_NEAR(field.at("horizontal").get<double>(), 90, 1e-9);
    EXPECT_NEAR(field.at("vertical").get<double>(), 90, 1e-9);
}

TEST(CalibrationJson, HasPortsAndWhatCanBeWritten) {
    Calibration calibration = odd_calibration();
    DomePortDesc dome;
    dome.center = {0, 0, 0.01};
    dome.radius = 0.05;
    calibration.desc.port = dome;
    const Json json = json_of_calibration(calibration);
    EXPECT_EQ(json.at("port").at("type"), "dome");
    EXPECT_EQ(json.at("port").at("center"), Json({0.0, 0.0, 0.01}));
    EXPECT_EQ(json.at("to"), Json({"calibmar", "colmap", "scene"}));
    calibration.desc.port = FlatPortDesc();
    EXPECT_EQ(json_of_calibration(calibration).at("port").at("type"), "flat");
}

}  // namespace
}  // namespace uw
