// ctest labels: unit
#include <gtest/gtest.h>

#include "camera/calibration.h"
#include "tests/support/calibration_reading.h"
#include "tests/support/calibration_texts.h"

namespace uw {
namespace {

using test::replaced;

class CalibmarYaml : public test::CalibrationReading {};

TEST_F(CalibmarYaml, RefusesInOneLine) {
    const std::string& flat = test::k_calibmar_flat;
    expect_refused(replaced(flat, "model: OPENCV\n", ""), "'model' is missing");
    expect_refused(replaced(flat, "width: 1920\n", ""), "'width' is missing");
    expect_refused(replaced(flat, "OPENCV", "OPENCW"), "did you mean 'OPENCV'?");
    expect_refused(replaced(flat, "OPENCV", "FOV"),
                   "the camera model FOV is not supported; calibrate with");
    expect_refused(replaced(flat, "[705.391983, ", "["),
                   "OPENCV has 8 parameters (fx fy cx cy k1 k2 p1 p2)");
    expect_refused(replaced(flat, "705.391983", "0"), "parameters[0]: must be greater than 0");
    expect_refused(replaced(flat, "FLATPORT", "FLATPORD"), "did you mean 'FLATPORT'?");
    expect_refused(replaced(flat, ", 1.333]", "]"), "FLATPORT has 8 parameters");
    expect_refused(replaced(flat, "1.333]", "13.33]"), "must be from 1 to 3, found 13.33");
    expect_refused(replaced(flat, "0.9999040533", "0.5"), "has length 0.5");
    expect_refused(replaced(flat, "0.9999040533", "-0.9999040533"),
                   "must point away from the camera");
    expect_refused(replaced(flat, "0.02531637365", "-0.1"), "must not be negative, found -0.1");
    const std::string& dome = test::k_calibmar_dome;
    expect_refused(replaced(dome, "0.0087,", "0.0587,"), "the camera is outside its dome");
    expect_refused(replaced(dome, "0.05, ", "0, "), "must be greater than 0, found 0");
    expect_refused(replaced(dome, "DOMEPORT", "[DOMEPORT]"), "expected text, found a list of 1");
}

TEST_F(CalibmarYaml, HasAModelAndAPort) {
    const Calibration flat = read(test::k_calibmar_flat);
    EXPECT_EQ(flat.format, CalibrationFormat::calibmar);
    EXPECT_EQ(flat.desc.width, 1920);
    EXPECT_EQ(flat.desc.intrinsics.cy, 604.968632);  // the image's corner is at 0 in the file
    EXPECT_EQ(flat.desc.distortion.p[1], -8.6e-05);
    EXPECT_EQ(std::get<FlatPortDesc>(flat.desc.port.value()).distance, 0.02531637365);
    const Calibration dome = read(test::k_calibmar_dome);
    EXPECT_EQ(dome.desc.distortion.model, DistortionDesc::Model::fisheye);
    EXPECT_EQ(std::get<DomePortDesc>(dome.desc.port.value()).n_glass, 1.473);
}

TEST_F(CalibmarYaml, WritesWhatItReads) {
    for (const std::string& text : {test::k_calibmar_flat, test::k_calibmar_dome}) {
        const CameraDesc camera = read(text).desc;
        const CameraDesc again = read(write_calibmar(camera)).desc;
        EXPECT_EQ(again.intrinsics.fx, camera.intrinsics.fx);
        EXPECT_EQ(again.distortion.k, camera.distortion.k);
        EXPECT_EQ(again.port->index(), camera.port->index());
    }
}

}  // namespace
}  // namespace uw
