// ctest labels: unit
#include "cli/tools/water_report.h"

#include <gtest/gtest.h>

#include "core/base/json.h"
#include "tests/support/water_reports.h"

namespace uw {
namespace {

using test::report_on_water;
using test::report_with_dye;

TEST(WaterJson, HasTheTableWithAllDigits) {
    const WaterSurvey report = report_on_water();
    const Json json = Json::parse(report_on_water(report).json());
    EXPECT_EQ(json.at("water"), "clear");
    EXPECT_EQ(json.at("sources"), Json({"a source"}));
    EXPECT_EQ(json.at("wavelengths_nm"), Json({540.0, 450.0}));
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(json.at("uniform").at("a")[i], report.table.uniform.absorption[i]);
        EXPECT_EQ(json.at("uniform").at("b")[i], report.table.uniform.scattering(i));
    }
    EXPECT_TRUE(json.at("constituents").empty());
}

TEST(WaterJson, RatiosOfNothingAreNull) {
    const Json json = Json::parse(report_on_water(report_with_dye("dye")).json());
    const Json& dye = json.at("constituents").at(0);
    EXPECT_EQ(dye.at("name"), "dye");
    EXPECT_EQ(dye.at("unit"), "1");
    EXPECT_EQ(dye.at("a"), Json({0.5, 0.25}));
    EXPECT_TRUE(dye.at("bb_over_b")[0].is_null());
    EXPECT_EQ(dye.at("albedo")[0], 0);
}

TEST(WaterJson, HasTheScatteringFunctionOfTheBandsAskedFor) {
    WaterSurvey report = report_on_water();
    report.vsf_bands = {1};
    const Json vsf = Json::parse(report_on_water(report).json()).at("vsf");
    EXPECT_EQ(vsf.at("angles_deg").size(), file_angles().size());
    ASSERT_EQ(vsf.at("bands").size(), 1U);
    EXPECT_EQ(vsf.at("bands")[0].at("wavelength_nm"), 450.0);
    EXPECT_EQ(vsf.at("bands")[0].at("total")[0], report.table.uniform.vsf(1, 0));
}

TEST(WaterJson, NamesFromFilesNeedNotBeText) {
    const Json json = Json::parse(report_on_water(report_with_dye("dye\xff")).json());
    EXPECT_EQ(json.at("constituents").at(0).at("name"), "dye\xEF\xBF\xBD");
}

}  // namespace
}  // namespace uw
