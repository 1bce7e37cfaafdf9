// ctest labels: unit analytic
#include "cli/tools/calibration_command.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {
namespace {

constexpr double k_one_degree = std::numbers::pi / 180;

/// 90 degrees wide and 53.13 high: half the image is the focal length across, half of that down.
Calibration plain_calibration() {
    Calibration calibration;
    calibration.camera = "left";
    calibration.model = "pinhole";
    calibration.desc.width = 1000;
    calibration.desc.height = 500;
    calibration.desc.intrinsics = {500, 500, 500, 250};
    return calibration;
}

const CalibrationSurvey::Target& target_of(const CalibrationSurvey& report,
                                           CalibrationFormat format) {
    return *std::ranges::find(report.targets, format, &CalibrationSurvey::Target::format);
}

TEST(CalibrationReport, FieldsOfViewOfAPinhole) {
    const CalibrationSurvey report = survey_calibration("c.yaml", plain_calibration());
    EXPECT_NEAR(report.in_lens.horizontal, 90 * k_one_degree, 1e-12);
    EXPECT_NEAR(report.in_lens.vertical, 2 * std::atan(0.5), 1e-12);
    EXPECT_NEAR(report.in_lens.diagonal, 2 * std::atan(std::sqrt(1.25)), 1e-12);
    EXPECT_FALSE(report.in_water);
    EXPECT_FALSE(report.fold_angle);
    EXPECT_EQ(report.covered, 1);
}

TEST(CalibrationReport, AFlatPortNarrowsTheViewByItsIndex) {
    Calibration calibration = plain_calibration();
    FlatPortDesc port;
    port.n_air = 1;
    port.n_water = 1.333;
    calibration.desc.port = port;
    const CalibrationSurvey report = survey_calibration("c.yaml", calibration);
    EXPECT_NEAR(report.in_lens.horizontal, 90 * k_one_degree, 1e-12);
    ASSERT_TRUE(report.in_water);
    EXPECT_NEAR(report.in_water->horizontal, 2 * std::asin(std::sqrt(0.5) / 1.333), 1e-9);
    EXPECT_NE(target_of(report, CalibrationFormat::kalibr).obstacle, "");
    EXPECT_EQ(target_of(report, CalibrationFormat::colmap).obstacle, "");
}

TEST(CalibrationReport, FindsWhereALensFolds) {
    // r (1 - r^2 / 3) grows up to r = 1: 45 degrees, and 2/3 of the focal length in the image.
    Calibration calibration = plain_calibration();
    calibration.desc.distortion.k[0] = -1.0 / 3;
    const CalibrationSurvey report = survey_calibration("c.yaml", calibration);
    EXPECT_NEAR(report.fold_angle.value(), 45 * k_one_degree, 1e-12);
    EXPECT_NEAR(report.fold_radius.value(), 500 * 2.0 / 3, 1e-9);
    // The image reaches beyond: a part of its pixels has no ray.
    EXPECT_LT(report.covered, 0.9);
    EXPECT_GT(report.covered, 0.5);
}

TEST(CalibrationReport, ReadsAsText) {
    const std::string text =
        report_on_calibration(survey_calibration("dir/c.yaml", plain_calibration())).text();
    for (const char* part : {"c.yaml", "left", "pinhole", "1000 x 500", "90.00 x 53.13 deg"})
        EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
    EXPECT_TRUE(
        std::ranges::all_of(text, [](char c) { return c == '\n' || (c >= ' ' && c < 127); }));
}

}  // namespace
}  // namespace uw
