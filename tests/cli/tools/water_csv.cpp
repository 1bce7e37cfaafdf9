// ctest labels: unit
#include "cli/tools/water_report.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/base/csv_table.h"
#include "tests/support/water_reports.h"

namespace uw {
namespace {

using test::report_on_water;
using test::report_with_dye;

TEST(WaterCsv, HasTheTablesCoefficients) {
    const WaterSurvey report = report_on_water();
    const std::string text = water_coefficients_csv(report);
    EXPECT_TRUE(text.starts_with("# clear: coefficients of the water")) << text;
    const CsvTable csv(text, "t.csv");
    EXPECT_EQ(csv.numbers("wavelength_nm"), report.table.wavelengths_nm);
    const CoefficientTable& uniform = report.table.uniform;
    for (std::size_t i = 0; i < csv.row_count(); ++i) {
        const auto expect_cell = [&](const char* column, double value) {
            EXPECT_NEAR(csv.numbers(column)[i], value, 1e-8 * value) << column;
        };
        expect_cell("a_per_m", uniform.absorption[i]);
        expect_cell("b_per_m", uniform.scattering(i));
        expect_cell("c_per_m", uniform.absorption[i] + uniform.scattering(i));
        expect_cell("attenuation_length_m", 1 / (uniform.absorption[i] + uniform.scattering(i)));
        expect_cell("b_water_per_m", uniform.parts[0].b[i]);
    }
}

TEST(WaterCsv, NamesTheUnitsOfWhatGridsAdd) {
    const CsvTable csv(water_coefficients_csv(report_with_dye("dye")), "t.csv");
    EXPECT_EQ(csv.numbers("dye_a_per_m_per_unit"), (std::vector<double>{0.5, 0.25}));
    // It does not scatter: ratios of 0 to 0 are blank.
    EXPECT_EQ(csv.text("dye_bb_over_b"), (std::vector<std::string>{"", ""}));
}

TEST(WaterCsv, QuotesNamesFromFiles) {
    const std::string text = water_coefficients_csv(report_with_dye("a,\"b\"\n"));
    EXPECT_NE(text.find("\"a,\"\"b\"\"\n_a_per_m_per_unit\""), std::string::npos) << text;
}

TEST(WaterCsv, HasTheScatteringFunctionOfEachBandAtAllAngles) {
    WaterSurvey report = report_on_water();
    report.vsf_bands = {1};
    const CsvTable csv(water_vsf_csv(report), "t.csv");
    EXPECT_EQ(csv.numbers("angle_deg"), file_angles());
    const std::vector<double> total = csv.numbers("total_per_m_per_sr");
    for (std::size_t i = 0; i < total.size(); ++i) {
        const double psi = file_angles()[i] * std::numbers::pi / 180;
        EXPECT_NEAR(total[i], report.table.uniform.vsf(1, psi), 1e-8 * total[i]);
    }
}

}  // namespace
}  // namespace uw
