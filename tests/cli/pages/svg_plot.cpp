// ctest labels: unit
#include "cli/pages/svg_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

#include "tests/support/xml_check.h"

namespace uw {
namespace {

using test::occurrences;
using test::xml_fault;

PlotFigure small_figure() {
    PlotFigure figure;
    figure.title = "Water";
    figure.caption = {"a line"};
    PlotPanel panel{"Panel", {"x [m]", {}}, {"y [1/m]", {}}, {}};
    panel.x.request.min = 0;
    panel.x.request.max = 10;
    panel.y.request.min = 0;
    panel.y.request.max = 1;
    panel.curves.push_back({"one", {0, 5, 10}, {0, 0.5, 1}});
    figure.panels.push_back(panel);
    return figure;
}

/// Points of the first curve's path.
std::vector<std::pair<double, double>> points(const std::string& svg) {
    std::smatch path;
    EXPECT_TRUE(std::regex_search(svg, path, std::regex("class=\"curve\" d=\"([^\"]*)\"")));
    std::vector<std::pair<double, double>> found;
    const std::string data = path[1];
    const std::regex number("[ML]([-0-9.]+) ([-0-9.]+)");
    for (std::sregex_iterator at(data.begin(), data.end(), number), end; at != end; ++at)
        found.emplace_back(std::stod((*at)[1]), std::stod((*at)[2]));
    return found;
}

TEST(SvgPlot, IsWellFormedAndSelfContained) {
    const std::string svg = svg_document(small_figure());
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(occurrences(svg, "href"), 0);
    EXPECT_EQ(occurrences(svg, "http"), 1);  // the namespace
    EXPECT_EQ(occurrences(svg, "<script"), 0);
    for (const char* text : {">Water<", ">a line<", ">Panel<", ">x [m]<", ">y [1/m]<", ">one<"})
        EXPECT_GE(occurrences(svg, text), 1) << text;
    EXPECT_EQ(svg, svg_document(small_figure()));
}

// Straight lines stay straight, the axes' ends are the frame's corners, y grows upwards.
TEST(SvgPlot, CurvesLieWhereTheAxesSay) {
    PlotFigure figure = small_figure();
    const std::string svg = svg_document(figure);
    std::smatch frame;
    ASSERT_TRUE(std::regex_search(
        svg, frame,
        std::regex("class=\"frame\" x=\"([0-9.]+)\" y=\"([0-9.]+)\" width=\"([0-9.]+)\" "
                   "height=\"([0-9.]+)\"")));
    const double left = std::stod(frame[1]), top = std::stod(frame[2]);
    const double right = left + std::stod(frame[3]), bottom = top + std::stod(frame[4]);
    auto path = points(svg);
    ASSERT_EQ(path.size(), 3U);
    constexpr double k_digits = 0.11;  // the frame is written to 0.1 pixels
    EXPECT_NEAR(path[0].first, left, k_digits);
    EXPECT_NEAR(path[0].second, bottom, k_digits);
    EXPECT_NEAR(path[1].first, (left + right) / 2, k_digits);
    EXPECT_NEAR(path[1].second, (top + bottom) / 2, k_digits);
    EXPECT_NEAR(path[2].first, right, k_digits);
    EXPECT_NEAR(path[2].second, top, k_digits);

    // The middle of a log axis is the geometric mean.
    figure.panels[0].y.request = {AxisScale::log, 1e-4, 1.0, {}};
    figure.panels[0].curves[0].y = {1e-4, 1e-2, 1};
    path = points(svg_document(figure));
    ASSERT_EQ(path.size(), 3U);
    EXPECT_NEAR(path[1].second, (path[0].second + path[2].second) / 2, k_digits);
}

TEST(SvgPlot, PointsThatCannotBeShownBreakTheLine) {
    PlotFigure figure = small_figure();
    figure.panels[0].curves[0] = {"gap",
                                  {0, 1, 2, 3, 4},
                                  {0.1, std::numeric_limits<double>::quiet_NaN(), 0.3, 0.4, 1e300},
                                  plot_colour::k_blue,
                                  "",
                                  1,
                                  true};
    const std::string svg = svg_document(figure);
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(occurrences(svg, "nan"), 0);
    EXPECT_EQ(points(svg).size(), 4U);
    EXPECT_EQ(occurrences(svg, "M"), occurrences(svg_document(small_figure()), "M") + 1);
    EXPECT_EQ(occurrences(svg, "<circle"), 3 + 1);  // three inside the frame, one in the legend
    figure.panels[0].y.request = {AxisScale::log, {}, {}, {}};
    figure.panels[0].curves[0].y = {0, -1, 1, 2, std::numeric_limits<double>::infinity()};
    EXPECT_EQ(points(svg_document(figure)).size(), 2U);
}

TEST(SvgPlot, NamesFromFilesCannotBreakOut) {
    PlotFigure figure = small_figure();
    figure.title = "</text><script>\"&\xff\x01";
    figure.panels[0].curves[0].label = "a<b & \"c\"";
    figure.panels[0].title = "]]>";
    figure.caption = {"<!--"};
    const std::string svg = svg_document(figure);
    EXPECT_EQ(xml_fault(svg), "");
    EXPECT_EQ(occurrences(svg, "<script"), 0);
    EXPECT_NE(svg.find("a&lt;b &amp; &quot;c&quot;"), std::string::npos);
}

// Legends wrap rather than leave the panel, and the frame begins below the lowest row.
TEST(SvgPlot, LegendsStandAboveTheFrame) {
    PlotFigure figure = small_figure();
    figure.panels[0].curves.resize(7, figure.panels[0].curves[0]);
    for (std::size_t i = 0; i < 7; ++i)
        figure.panels[0].curves[i].label = "a rather long name " + std::to_string(i);
    const std::string svg = svg_document(figure);
    std::smatch frame;
    ASSERT_TRUE(
        std::regex_search(svg, frame, std::regex("class=\"frame\" x=\"[0-9.]+\" y=\"([0-9.]+)\"")));
    const std::regex entry("<text x=\"([0-9.]+)\" y=\"([0-9.]+)\"[^>]*>a rather");
    int entries = 0;
    for (std::sregex_iterator at(svg.begin(), svg.end(), entry), end; at != end; ++at, ++entries) {
        EXPECT_LT(std::stod((*at)[2]), std::stod(frame[1]));
        EXPECT_LT(std::stod((*at)[1]) + text_width("a rather long name 0", 13),
                  figure.panel_width + 30);
    }
    EXPECT_EQ(entries, 7);
}

TEST(SvgPlot, EmptyFiguresArePlotsToo) {
    EXPECT_EQ(xml_fault(svg_document({})), "");
    PlotFigure figure;
    figure.panels.resize(3);
    EXPECT_EQ(xml_fault(svg_document(figure)), "");
}

}  // namespace
}  // namespace uw
