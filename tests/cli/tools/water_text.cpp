// ctest labels: unit
#include "cli/tools/water_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/support/water_reports.h"

namespace uw {
namespace {

using test::report_on_water;
using test::report_with_dye;

TEST(WaterText, BeginsWithTitleAndSources) {
    EXPECT_TRUE(report_on_water(report_on_water()).text().starts_with("clear\n  a source\n"));
}

TEST(WaterText, ColumnsAreAlignedUnderTheirUnits) {
    std::istringstream lines(report_on_water(report_on_water()).text());
    std::vector<std::string> table;
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("       band") || !table.empty()) {
            if (line.empty()) break;
            table.push_back(line);
        }
    ASSERT_EQ(table.size(), 4U);  // names, units, two wavelengths
    for (const std::string& line : table) EXPECT_EQ(line.size(), table[0].size()) << line;
    EXPECT_NE(table[1].find("[nm]"), std::string::npos);
    EXPECT_EQ(table[2].substr(8, 3), "540");
}

TEST(WaterText, RatiosOfNothingAreDashes) {
    const std::string text = report_on_water(report_with_dye("dye")).text();
    EXPECT_NE(text.find("What grids add: 'dye', per unit of the grid's value"), std::string::npos);
    EXPECT_NE(text.find(" - "), std::string::npos) << text;
}

TEST(WaterText, AnglesAscendFromForwardToBackward) {
    for (const std::vector<double>* angles : {&printed_angles(), &file_angles()}) {
        EXPECT_TRUE(std::ranges::is_sorted(*angles));
        EXPECT_EQ(std::ranges::adjacent_find(*angles), angles->end());
        EXPECT_EQ(angles->back(), 180);
    }
    EXPECT_EQ(file_angles().front(), 0);
    EXPECT_EQ(file_angles().size(), 10U + 9 + 180);
}

}  // namespace
}  // namespace uw
