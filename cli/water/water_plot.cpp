#include "cli/water/water_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "media/water/pure_water.h"

namespace uw {

namespace {

/// More bands than this are so close that their dots would hide the curve.
constexpr std::size_t k_most_dots = 40;

using Value = std::function<double(const CoefficientTable&, std::size_t)>;

struct LineStyle {
    const char* colour;
    const char* dashes;
};

/// The hues of the paper's figure 4: total magenta, water red, small green, large blue.
LineStyle style_of(const std::string& part) {
    if (part == "total") return {plot_colour::k_purple, ""};
    if (part == "water") return {plot_colour::k_red, "8 3"};
    if (part == "small") return {plot_colour::k_green, "2 2.5"};
    if (part == "large") return {plot_colour::k_blue, "9 3 2 3"};
    return {plot_colour::k_orange, "5 2"};
}

/// For components without a colour of their own.
LineStyle style_of(std::size_t index) {
    static constexpr std::array<LineStyle, 5> k_styles{{{plot_colour::k_green, "2 2.5"},
                                                        {plot_colour::k_blue, "9 3 2 3"},
                                                        {plot_colour::k_orange, ""},
                                                        {plot_colour::k_sky, "5 2"},
                                                        {plot_colour::k_black, "8 3"}}};
    return k_styles[index % k_styles.size()];
}

/// The same water at many wavelengths, as far as its models extend.
struct FineCurves {
    WaterTable table;
    bool absorption, scattering;  // whether those of the uniform water are known
};

/// First and last wavelength [nm] of the plots: the visible range, extended to the bands.
std::pair<double, double> plotted_range(const WaterReport& report) {
    const std::vector<double>& bands = report.table.wavelengths_nm;
    const auto [low, high] = std::minmax_element(bands.begin(), bands.end());
    return {std::floor(std::min(400.0, *low)), std::ceil(std::max(700.0, *high))};
}

FineCurves fine_curves(const WaterReport& report) {
    FineCurves fine{{}, !report.water.absorption, !report.water.scattering};
    WaterDesc water = report.water;
    water.absorption.reset();
    water.scattering.reset();
    std::vector<VolumeDesc> volumes = report.volumes;
    for (VolumeDesc& volume : volumes)
        std::erase_if(volume.grids,
                      [](const GridMappingDesc& grid) { return grid.optics.has_value(); });
    const WavelengthRange known = pure_water_absorption_range();
    const double first = std::max(known.first_nm, plotted_range(report).first);
    const double last = std::min(known.last_nm, plotted_range(report).second);
    water.bands_nm.clear();
    for (double nm = first; nm <= last; nm += 2) water.bands_nm.push_back(nm);
    fine.table = tabulate_water(water, volumes);
    return fine;
}

PlotPanel spectral_panel(const WaterReport& report, const std::string& title,
                         const std::string& y_label) {
    PlotPanel panel{title, {"wavelength [nm]", {}}, {y_label, {}}, {}};
    const auto [first, last] = plotted_range(report);
    panel.x.request.min = first;
    panel.x.request.max = last;
    panel.y.request.scale = AxisScale::log;
    return panel;
}

/// Adds one quantity over wavelength: the fine curve, if there is one, and dots at the bands.
void add_spectrum(PlotPanel& panel, const std::string& label, LineStyle style,
                  const WaterTable& bands, const CoefficientTable& at_bands, const WaterTable& fine,
                  const CoefficientTable* at_fine, const Value& value) {
    PlotCurve dots{label, bands.wavelengths_nm, {}, style.colour, style.dashes, 0, true};
    for (std::size_t i = 0; i < dots.x.size(); ++i) dots.y.push_back(value(at_bands, i));
    if (at_fine) {
        PlotCurve line{label, fine.wavelengths_nm, {}, style.colour, style.dashes};
        for (std::size_t i = 0; i < line.x.size(); ++i) line.y.push_back(value(*at_fine, i));
        panel.curves.push_back(std::move(line));
        if (dots.x.size() > k_most_dots) return;
        dots.label.clear();
    }
    panel.curves.push_back(std::move(dots));
}

Value b_of_part(std::size_t part) {
    return [part](const CoefficientTable& t, std::size_t i) { return t.parts[part].b[i]; };
}

const Value k_a = [](const CoefficientTable& t, std::size_t i) { return t.absorption[i]; };
const Value k_b = [](const CoefficientTable& t, std::size_t i) { return t.scattering(i); };
const Value k_c = [](const CoefficientTable& t, std::size_t i) { return t.attenuation(i); };
const Value k_bb = [](const CoefficientTable& t, std::size_t i) { return t.backscattering(i); };

PlotPanel coefficient_panel(const WaterReport& report, const FineCurves& fine) {
    PlotPanel panel = spectral_panel(report, "Coefficients", "coefficient [1/m]");
    const CoefficientTable* const table = &fine.table.uniform;
    const auto add = [&](const char* label, LineStyle style, bool known, const Value& value) {
        add_spectrum(panel, label, style, report.table, report.table.uniform, fine.table,
                     known ? table : nullptr, value);
    };
    add("c = a + b", {plot_colour::k_black, ""}, fine.absorption && fine.scattering, k_c);
    add("a", {plot_colour::k_blue, "8 3"}, fine.absorption, k_a);
    add("b", {plot_colour::k_red, "2 2.5"}, fine.scattering, k_b);
    add("b_b", {plot_colour::k_orange, "9 3 2 3"}, fine.scattering, k_bb);
    return panel;
}

PlotPanel scattering_panel(const WaterReport& report, const FineCurves& fine) {
    PlotPanel panel = spectral_panel(report, "Scattering by component", "b [1/m]");
    const CoefficientTable& uniform = report.table.uniform;
    const bool split = uniform.parts.size() != 1;
    const CoefficientTable* const table = fine.scattering ? &fine.table.uniform : nullptr;
    if (split)
        add_spectrum(panel, "total", style_of("total"), report.table, uniform, fine.table, table,
                     k_b);
    for (std::size_t part = 0; part < uniform.parts.size(); ++part)
        add_spectrum(panel, uniform.parts[part].name, style_of(uniform.parts[part].name),
                     report.table, uniform, fine.table, table, b_of_part(part));
    return panel;
}

/// What grids add; particles are known at all wavelengths, a grid's own coefficients at the bands.
PlotPanel constituent_panel(const WaterReport& report, const FineCurves& fine) {
    PlotPanel panel = spectral_panel(report, "What grids add: attenuation", "c* [1/m per unit]");
    for (std::size_t k = 0; k < report.table.constituents.size(); ++k) {
        const CoefficientTable& constituent = report.table.constituents[k];
        const CoefficientTable* known = nullptr;
        for (const CoefficientTable& other : fine.table.constituents)
            if (constituent.unit == "ppm" && other.name == constituent.name) known = &other;
        add_spectrum(panel,
                     fmt::format("{} (per {})", constituent.name,
                                 constituent.unit == "1" ? "grid unit" : constituent.unit),
                     style_of(k), report.table, constituent, fine.table, known, k_c);
    }
    return panel;
}

/// Angles [deg] fine enough for the forward peak on a logarithmic axis and the rest on a linear
/// one. The peak below 0.1 degrees, unbounded in some models, would leave no room for the rest.
std::vector<double> plot_angles() {
    std::vector<double> angles;
    angles.reserve(60 + 171);
    for (int i = 0; i < 60; ++i) angles.push_back(0.1 * std::pow(10, i / 30.0));
    for (double angle = 10; angle <= 180; angle += 1) angles.push_back(angle);
    return angles;
}

void add_angular(PlotPanel& panel, const std::string& label, LineStyle style, double width,
                 const std::function<double(double psi)>& beta) {
    PlotCurve curve{label, plot_angles(), {}, style.colour, style.dashes, width};
    for (const double angle : curve.x) curve.y.push_back(beta(angle * std::numbers::pi / 180));
    panel.curves.push_back(std::move(curve));
}

PlotPanel angular_panel(const std::string& title, const std::string& y_label, AxisScale scale) {
    PlotPanel panel{title, {"scattering angle [°]", {}}, {y_label, {}}, {}};
    panel.x.request = {scale, scale == AxisScale::log ? 0.1 : 0.0, 180.0, 30.0};
    panel.y.request.scale = AxisScale::log;
    return panel;
}

PlotPanel vsf_panel(const WaterReport& report, AxisScale scale) {
    const std::size_t band = report.plot_band;
    const CoefficientTable& uniform = report.table.uniform;
    PlotPanel panel = angular_panel(
        fmt::format("Volume scattering function at {:g} nm{}", report.table.wavelengths_nm[band],
                    scale == AxisScale::log ? ", log-log" : ""),
        "β [1/(m sr)]", scale);
    if (uniform.parts.size() != 1)
        add_angular(panel, "total", style_of("total"), 3,
                    [&](double psi) { return uniform.vsf(band, psi); });
    for (std::size_t part = 0; part < uniform.parts.size(); ++part)
        add_angular(panel, uniform.parts[part].name, style_of(uniform.parts[part].name), 1.8,
                    [&](double psi) { return uniform.vsf(band, part, psi); });
    return panel;
}

PlotPanel constituent_vsf_panel(const WaterReport& report) {
    const std::size_t band = report.plot_band;
    PlotPanel panel = angular_panel(
        fmt::format("What grids add: VSF at {:g} nm", report.table.wavelengths_nm[band]),
        "β* [1/(m sr) per unit]", AxisScale::log);
    for (std::size_t k = 0; k < report.table.constituents.size(); ++k) {
        const CoefficientTable& constituent = report.table.constituents[k];
        add_angular(panel, constituent.name, style_of(k), 1.8,
                    [&](double psi) { return constituent.vsf(band, psi); });
    }
    return panel;
}

}  // namespace

PlotFigure water_figure(const WaterReport& report) {
    const FineCurves fine = fine_curves(report);
    PlotFigure figure;
    figure.title = "Water: " + report.title;
    figure.caption = report.sources;
    figure.panels = {coefficient_panel(report, fine), scattering_panel(report, fine),
                     vsf_panel(report, AxisScale::linear), vsf_panel(report, AxisScale::log)};
    if (!report.table.constituents.empty()) {
        figure.panels.push_back(constituent_panel(report, fine));
        figure.panels.push_back(constituent_vsf_panel(report));
    }
    return figure;
}

}  // namespace uw
