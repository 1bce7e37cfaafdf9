#include "cli/validate/published_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "cli/pages/html_page.h"
#include "cli/pages/svg_plot.h"
#include "core/base/version.h"
#include "render/validation/published_tables.h"

namespace uw {

namespace {

ReportTable table_of(const std::vector<PublishedFigure>& figures) {
    ReportTable table{
        {"source", "quantity", "published", "spread", "ours", "±", "difference", "allowed"}, 2};
    for (const PublishedFigure& figure : figures) {
        const std::string allowed = fmt::format("{:.2f} %", 100 * figure.allowed());
        table.rows.push_back(
            {{figure.source, figure.quantity, fmt::format("{:.4g}", figure.published),
              figure.spread > 0 ? fmt::format("{:.1f} %", 100 * figure.spread) : "",
              fmt::format("{:.4g}", figure.ours),
              figure.error > 0 ? fmt::format("{:.1f} %", 100 * figure.error) : "",
              fmt::format("{:+.2f} %", 100 * figure.difference()),
              (figure.is_bound ? "< +" : "±") + allowed},
             figure.passed() ? Verdict::passed : Verdict::failed});
    }
    return table;
}

std::string on_photographs(const std::vector<PortPhotographs>& sets) {
    const auto px = [](double rms) { return rms > 0 ? fmt::format("{:.3g}", rms) : "-"; };
    ReportTable table{{"photographs", "corners", "no port, published", "ours", "port, published",
                       "ours", "in air"},
                      1};
    PlotFigure figure;
    figure.columns = 3;
    figure.panel_width = 320;
    figure.panel_height = 350;
    figure.caption = {
        "Where corners were found, from where the camera model has them. Orange: a plain lens, the "
        "boards moved to fit best; blue: with the port, nothing fitted here."};
    for (const PortPhotographs& set : sets) {
        table.rows.push_back(
            {{set.source, fmt::format("{}", set.port.size()), px(set.published_plain),
              px(rms_of(set.plain)), px(set.published_port), px(rms_of(set.port)),
              px(set.published_air)}});
        PlotPanel panel;
        panel.title = set.port_name;
        panel.x.label = "to the right [px]";
        panel.y.label = "down [px]";
        double farthest = 0;
        for (const auto& [label, residuals, colour] :
             {std::tuple{"no port", &set.plain, plot_colour::k_orange},
              std::tuple{"port", &set.port, plot_colour::k_blue}}) {
            PlotCurve points{label, {}, {}, colour, "", 0, true};
            for (const ImagePoint& residual : *residuals) {
                points.x.push_back(residual.x);
                points.y.push_back(residual.y);
                farthest = std::max({farthest, std::abs(residual.x), std::abs(residual.y)});
            }
            panel.curves.push_back(std::move(points));
        }
        for (PlotAxis* axis : {&panel.x, &panel.y}) {
            axis->request.min = -farthest;
            axis->request.max = farthest;
        }
        figure.panels.push_back(std::move(panel));
    }
    return "<h2>Photographs through ports</h2>\n"
           "<p>Corners of boards were detected in real photographs, and an independent model of "
           "each camera and its port posed the boards; the lens was calibrated in air. Given are "
           "root mean square distances in pixels between where a corner was found and where a "
           "model "
           "has it. With the port, nothing is fitted here: the poses are those of the independent "
           "model, and the scene's camera projects the corners. Without, a plain lens takes the "
           "port's place, and the boards of each photograph are moved to fit best; the published "
           "figure is the independent model's for the same. What photographs in air leave is the "
           "noise of the corners.</p>\n" +
           table.html() + plot_html(figure);
}

constexpr std::array k_curve_colours{plot_colour::k_blue, plot_colour::k_orange,
                                     plot_colour::k_green, plot_colour::k_purple};

void append_point(PlotCurve& curve, double x, double y) {
    curve.x.push_back(x);
    curve.y.push_back(y);
}

void append_bar(PlotCurve& curve, double x, double middle, double half) {
    append_point(curve, x, middle - half);
    append_point(curve, x, middle + half);
    append_point(curve, x, std::numeric_limits<double>::quiet_NaN());
}

/// Two panels for figures that have one as their place: values, and differences with what is
/// allowed.
void append_panels(std::span<const PublishedFigure> figures, std::vector<PlotPanel>& panels) {
    std::vector<std::string> curves;
    double least = figures.front().place.x, most = least;
    for (const PublishedFigure& figure : figures) {
        if (std::ranges::find(curves, figure.place.curve) == curves.end())
            curves.push_back(figure.place.curve);
        least = std::min(least, figure.place.x);
        most = std::max(most, figure.place.x);
    }
    PlotPanel values, differences;
    for (PlotPanel* panel : {&values, &differences}) {
        panel->x.label = figures.front().place.axis;
        panel->x.request.min = least - 1;
        panel->x.request.max = most + 1;
    }
    values.title = figures.front().place.panel;
    values.y.label = "published (line), ours (dots)";
    values.y.request.scale = AxisScale::log;
    differences.title = "ours - published, ± 2 errors";
    differences.y.label = "%";
    PlotCurve allowed{"allowed", {}, {}, "#cccccc", "", 7};
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const char* colour = k_curve_colours[i % k_curve_colours.size()];
        PlotCurve published{curves[i], {}, {}, colour, "6 3"},
            ours{"", {}, {}, colour, "", 0, true};
        PlotCurve points{curves[i], {}, {}, colour, "", 0, true}, bars{"", {}, {}, colour, "", 1.5};
        // Side by side.
        const double aside =
            0.2 * (static_cast<double>(i) - static_cast<double>(curves.size() - 1) / 2);
        for (const PublishedFigure& figure : figures) {
            if (figure.place.curve != curves[i]) continue;
            const double x = figure.place.x, difference = 100 * figure.difference();
            append_point(published, x, figure.published);
            append_point(ours, x, figure.ours);
            append_point(points, x + aside, difference);
            append_bar(bars, x + aside, difference, 200 * figure.error);
            append_bar(allowed, x + aside, 0, 100 * figure.tolerance);
        }
        values.curves.push_back(std::move(published));
        values.curves.push_back(std::move(ours));
        differences.curves.push_back(std::move(points));
        differences.curves.push_back(std::move(bars));
    }
    differences.curves.insert(differences.curves.begin(), std::move(allowed));
    panels.push_back(std::move(values));
    panels.push_back(std::move(differences));
}

std::string plots_of(std::span<const PublishedFigure> figures) {
    PlotFigure plot;
    while (!figures.empty()) {
        const std::string& panel = figures.front().place.panel;
        std::size_t count = 1;
        while (count < figures.size() && figures[count].place.panel == panel) ++count;
        if (!panel.empty()) append_panels(figures.first(count), plot.panels);
        figures = figures.subspan(count);
    }
    return plot.panels.empty() ? "" : plot_html(plot);
}

std::string on_light() {
    return "<h2>Light in water</h2>\n"
           "<p><b>Canonical problems of ocean optics</b> (Mobley et al. 1993): sun at 60° in the "
           "air "
           "over calm water of n = 1.34 under a black sky, Rayleigh's or particles' phase "
           "function, "
           "no floor, or in problem 6 one of reflectance 0.5; in problem 3 chlorophyll that "
           "changes "
           "with depth, in problem 5 a sun at 80° over waves whose slopes have a standard "
           "deviation "
           "of 0.2. Ed is plane irradiance that travels "
           "down, Eou scalar irradiance from below, Lu radiance that travels straight up; those "
           "published are means of up to seven models, with their spread. Ours are read by light "
           "meters, which follow light paths in all orders of scattering, through the surface and "
           "back from it; ± is their standard error. A difference passes within 1.5 % or twice the "
           "spread, half a per cent more where three digits were printed, and two errors of ours. "
           "The "
           "models average Lu over a polar cap of up to 26°; ours is straight up. At optical depth "
           "10 and albedo 0.2, what travels up comes by rare paths, and our error is "
           "understated.</p>\n"
           "<p><b>Asymptotic K</b>: the attenuation of Ed between optical depths 15 and 27, where "
           "only the slowest part of the light is left; the published range is that of the models. "
           "<b>Petzold</b>: the library's measured volume scattering functions, integrated. "
           "<b>Cycles</b>: light scattered any number of times around a point lamp in uniform "
           "water "
           "(c = 1/m, albedo 0.8, Henyey-Greenstein, g = 0.9), as another renderer has it, whose "
           "own "
           "error is the spread.</p>\n";
}

std::string on_sources() {
    std::string html =
        "<h2>Sources</h2>\n<p>The first lines of the files in assets/published, whose numbers are "
        "compiled into the program:</p>\n<pre>";
    for (const PublishedTable& table : published_tables()) {
        html += fmt::format("{}\n", table.name);
        std::string_view rest = table.text;
        while (rest.starts_with('#')) {
            const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
            html += "    " + xml_escaped(std::string(rest.substr(1, end - 1)));
            rest.remove_prefix(end);
        }
    }
    html +=
        "</pre>\n<p>Further truths are met elsewhere: radiance around a point lamp by order of "
        "scattering, against quadrature (<code>uwvdb validate</code>); the figures of Sedlazeck "
        "and "
        "Koch's paper (docs/gallery.md); Kopelevich's, Jerlov's and Mie's tables (the project's "
        "tests).</p>\n<h2>How to cite</h2>\n<p>By the version above and the project's "
        "CITATION.cff:</p>\n<pre>";
    for (const PublishedTable& file : citation_files()) html += xml_escaped(std::string(file.text));
    return html + "</pre>\n";
}

}  // namespace

std::string published_text(const PublishedComparison& comparison, bool colour) {
    return table_of(comparison.figures).text(colour);
}

std::string published_page(const PublishedComparison& comparison) {
    const auto passed = std::ranges::count_if(comparison.figures, &PublishedFigure::passed);
    std::string html = fmt::format(
        "<p>{} figures that others measured, photographed or computed, and the same by uwvdb: {}, "
        "{} "
        "of {} within what is allowed. Made by <code>uwvdb validate --published --report "
        "FILE.html</code>, version {} ({}); the same program makes the same page.</p>\n",
        comparison.figures.size(), verdict_html(comparison.passed()), passed,
        comparison.figures.size(), xml_escaped(program_version()), xml_escaped(build_libraries()));
    if (!comparison.photographs.empty()) html += on_photographs(comparison.photographs);
    html += on_light() + plots_of(comparison.figures);
    html += "<h2>All figures</h2>\n" + table_of(comparison.figures).html() + on_sources();
    return html_page("uwvdb against what others have published", html);
}

}  // namespace uw
