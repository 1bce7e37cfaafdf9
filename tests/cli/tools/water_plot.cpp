// ctest labels: unit
#include "cli/tools/water_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/support/water_reports.h"
#include "tests/support/xml_check.h"

namespace uw {
namespace {

using test::report_on_water;
using test::report_with_dye;

const PlotCurve& curve_called(const PlotPanel& panel, const std::string& label) {
    for (const PlotCurve& curve : panel.curves)
        if (curve.label == label) return curve;
    ADD_FAILURE() << "no curve called " << label;
    return panel.curves.front();
}

TEST(WaterPlot, CurvesAreThoseOfTheTable) {
    const WaterSurvey report = report_on_water();
    const PlotFigure figure = water_figure(report);
    EXPECT_EQ(figure.title, "Water: clear");
    ASSERT_EQ(figure.panels.size(), 4U);
    for (const PlotPanel& panel : figure.panels)
        for (const PlotCurve& curve : panel.curves) EXPECT_EQ(curve.x.size(), curve.y.size());
    // The fine curve of absorption passes through the table's dots.
    const PlotCurve absorption = curve_called(figure.panels[0], "a");
    for (std::size_t band = 0; band < 2; ++band) {
        const auto at = std::ranges::find(absorption.x, report.table.wavelengths_nm[band]);
        ASSERT_NE(at, absorption.x.end());
        EXPECT_NEAR(absorption.y[static_cast<std::size_t>(at - absorption.x.begin())],
                    report.table.uniform.absorption[band], 1e-12);
    }
}

TEST(WaterPlot, TheScatteringFunctionIsThatOfTheBandAskedFor) {
    WaterSurvey report = report_on_water();
    report.plot_band = 1;
    const PlotPanel panel = water_figure(report).panels[2];
    EXPECT_NE(panel.title.find("at 450 nm"), std::string::npos);
    const PlotCurve curve = curve_called(panel, "water");
    for (std::size_t i = 0; i < curve.x.size(); ++i)
        EXPECT_NEAR(curve.y[i], report.table.uniform.vsf(1, curve.x[i] * std::numbers::pi / 180),
                    1e-15);
}

TEST(WaterPlot, WhatGridsAddHasPanelsOfItsOwn) {
    const PlotFigure figure = water_figure(report_with_dye("<dye>"));
    ASSERT_EQ(figure.panels.size(), 6U);
    EXPECT_EQ(curve_called(figure.panels[4], "<dye> (per grid unit)").y,
              (std::vector<double>{0.5, 0.25}));
    EXPECT_EQ(test::xml_fault(svg_document(figure)), "");
}

}  // namespace
}  // namespace uw
