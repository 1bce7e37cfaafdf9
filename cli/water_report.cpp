#include "cli/water_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/base/json.h"
#include "core/base/vector_math.h"
#include "core/base/version.h"
#include "media/water/water_types.h"

namespace uw {

const std::vector<double>& printed_angles() {
    static const std::vector<double> k_angles{0.1, 0.2, 0.5, 1,  2,   5,   10,  15,  20,  30,
                                              45,  60,  75,  90, 105, 120, 135, 150, 165, 180};
    return k_angles;
}

const std::vector<double>& file_angles() {
    static const std::vector<double> k_angles = [] {
        std::vector<double> angles;
        angles.reserve(10 + 9 + 180);
        for (int i = 0; i < 10; ++i) angles.push_back(i / 100.0);
        for (int i = 1; i < 10; ++i) angles.push_back(i / 10.0);
        for (int i = 1; i <= 180; ++i) angles.push_back(i);
        return angles;
    }();
    return k_angles;
}

namespace {

constexpr std::size_t k_narrowest = 9;

/// Columns of right-aligned cells, each as wide as its widest cell.
class TextTable {
  public:
    void add_column(std::string name, std::string unit) {
        columns_.push_back({std::move(name), std::move(unit)});
    }
    void add(std::size_t column, double value) {
        // Column 0 is the wavelength or angle, printed with the digits given.
        const int digits = column == 0 ? 8 : 4;
        columns_[column].push_back(std::isfinite(value) ? fmt::format("{:.{}g}", value, digits)
                                                        : "-");
    }
    std::string text() const {
        std::string out;
        for (std::size_t row = 0; row < columns_[0].size(); ++row) {
            for (const std::vector<std::string>& column : columns_) {
                std::size_t width = k_narrowest;
                for (const std::string& cell : column) width = std::max(width, cell.size());
                out += fmt::format("  {:>{}}", column[row], width);
            }
            out += "\n";
        }
        return out;
    }

  private:
    std::vector<std::vector<std::string>> columns_;
};

std::string heading(const std::string& text) {
    return "\n" + text + "\n";
}

/// Unit of a coefficient per unit of concentration: "1/m", "1/m/ppm", "1/m per 1".
std::string per(const std::string& coefficient, const CoefficientTable& table) {
    if (table.unit.empty()) return fmt::format("[{}]", coefficient);
    return fmt::format("[{} per {}]", coefficient, table.unit == "1" ? "unit" : table.unit);
}

std::string coefficients(const WaterTable& water, const CoefficientTable& table) {
    TextTable text;
    const std::string per_metre = per("1/m", table);
    text.add_column("band", "[nm]");
    for (const char* name : {"a", "b", "c", "b_b"}) text.add_column(name, per_metre);
    for (const char* name : {"b_b/b", "b/c", "<cos psi>"}) text.add_column(name, "");
    const bool uniform = table.unit.empty();
    if (uniform) text.add_column("1/c", "[m]");
    const bool split = table.parts.size() > 1;
    if (split)
        for (const ScatteringPart& part : table.parts) text.add_column("b " + part.name, per_metre);
    for (std::size_t i = 0; i < water.wavelengths_nm.size(); ++i) {
        std::vector<double> row{water.wavelengths_nm[i], table.absorption[i],
                                table.scattering(i),     table.attenuation(i),
                                table.backscattering(i), table.backscatter_fraction(i),
                                table.albedo(i),         table.mean_cosine(i)};
        if (uniform) row.push_back(1 / table.attenuation(i));
        if (split)
            for (const ScatteringPart& part : table.parts) row.push_back(part.b[i]);
        for (std::size_t column = 0; column < row.size(); ++column) text.add(column, row[column]);
    }
    return text.text();
}

std::string vsf_text(const WaterReport& report, std::size_t band) {
    const CoefficientTable& uniform = report.table.uniform;
    TextTable text;
    text.add_column("psi", "[deg]");
    text.add_column("total", "[1/(m sr)]");
    const bool split = uniform.parts.size() > 1;
    if (split)
        for (const ScatteringPart& part : uniform.parts) text.add_column(part.name, "[1/(m sr)]");
    for (const CoefficientTable& constituent : report.table.constituents)
        text.add_column(constituent.name + "*", per("1/(m sr)", constituent));
    for (const double angle : printed_angles()) {
        const double psi = angle * k_degree;
        std::vector<double> row{angle, uniform.vsf(band, psi)};
        if (split)
            for (std::size_t part = 0; part < uniform.parts.size(); ++part)
                row.push_back(uniform.vsf(band, part, psi));
        for (const CoefficientTable& constituent : report.table.constituents)
            row.push_back(constituent.vsf(band, psi));
        for (std::size_t column = 0; column < row.size(); ++column) text.add(column, row[column]);
    }
    return text.text();
}

}  // namespace

std::string water_text(const WaterReport& report) {
    const WaterTable& water = report.table;
    std::string out = report.title + "\n";
    for (const std::string& line : report.sources) out += "  " + line + "\n";
    out += heading(
        "Coefficients of the water everywhere: absorption a, scattering b, attenuation c = a + b, "
        "backscattering b_b");
    if (water.uniform.parts.size() == 1)
        out += fmt::format("(all scattering is that of: {})\n", water.uniform.parts[0].name);
    out += coefficients(water, water.uniform);
    for (const CoefficientTable& constituent : water.constituents) {
        out += heading(
            fmt::format("What grids add: '{}', per {}", constituent.name,
                        constituent.unit == "1" ? "unit of the grid's value" : constituent.unit));
        out += coefficients(water, constituent);
    }
    for (const std::size_t band : report.vsf_bands) {
        out += heading(fmt::format(
            "Volume scattering function beta(psi) at {:g} nm; psi is the change of direction: 0 "
            "forward, 180 backward",
            water.wavelengths_nm[band]));
        out += vsf_text(report, band);
    }
    return out;
}

namespace {

/// A field of RFC 4180. Names come from users' files.
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

void add(std::string& row, const std::string& text) {
    row += (row.empty() ? "" : ",") + field(text);
}

void add(std::string& row, double value) {
    add(row, std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string());
}

std::string comment(const WaterReport& report, const std::string& what) {
    std::string out = fmt::format("# {}: {}", report.title, what);
    for (const std::string& source : report.sources) out += " | " + source;
    for (char& c : out)
        if (c == '\n' || c == '\r') c = ' ';
    return out + fmt::format(" | uwvdb {}\n", program_version());
}

/// "_per_m", "_per_m_per_ppm", "_per_m_per_unit".
std::string unit_suffix(const CoefficientTable& table, const std::string& per) {
    if (table.unit.empty()) return per;
    return per + (table.unit == "1" ? "_per_unit" : "_per_" + table.unit);
}

void name_coefficients(const CoefficientTable& table, std::string& header) {
    const std::string before = table.name.empty() ? "" : table.name + "_";
    const std::string after = unit_suffix(table, "_per_m");
    for (const char* name : {"a", "b", "c", "bb"})
        add(header, fmt::format("{}{}{}", before, name, after));
    for (const char* name : {"bb_over_b", "albedo", "mean_cosine"}) add(header, before + name);
}

void add_coefficients(const CoefficientTable& table, std::size_t i, std::string& row) {
    add(row, table.absorption[i]);
    add(row, table.scattering(i));
    add(row, table.attenuation(i));
    add(row, table.backscattering(i));
    add(row, table.backscatter_fraction(i));
    add(row, table.albedo(i));
    add(row, table.mean_cosine(i));
}

}  // namespace

std::string water_coefficients_csv(const WaterReport& report) {
    const WaterTable& water = report.table;
    std::string header;
    add(header, std::string("wavelength_nm"));
    name_coefficients(water.uniform, header);
    add(header, std::string("attenuation_length_m"));
    for (const ScatteringPart& part : water.uniform.parts) add(header, "b_" + part.name + "_per_m");
    for (const CoefficientTable& constituent : water.constituents)
        name_coefficients(constituent, header);
    std::string out = comment(report,
                              "coefficients of the water everywhere, then of what grids "
                              "add, per unit of its concentration") +
                      header + "\n";
    for (std::size_t i = 0; i < water.wavelengths_nm.size(); ++i) {
        std::string row;
        add(row, water.wavelengths_nm[i]);
        add_coefficients(water.uniform, i, row);
        add(row, 1 / water.uniform.attenuation(i));
        for (const ScatteringPart& part : water.uniform.parts) add(row, part.b[i]);
        for (const CoefficientTable& constituent : water.constituents)
            add_coefficients(constituent, i, row);
        out += row + "\n";
    }
    return out;
}

std::string water_vsf_csv(const WaterReport& report) {
    const WaterTable& water = report.table;
    std::string header = "wavelength_nm,angle_deg,total_per_m_per_sr";
    for (const ScatteringPart& part : water.uniform.parts) add(header, part.name + "_per_m_per_sr");
    for (const CoefficientTable& constituent : water.constituents)
        add(header, constituent.name + unit_suffix(constituent, "_grid_per_m_per_sr"));
    std::string out = comment(report,
                              "volume scattering function of the water everywhere and of "
                              "its components, then of what grids add") +
                      header + "\n";
    for (const std::size_t band : report.vsf_bands)
        for (const double angle : file_angles()) {
            const double psi = angle * std::numbers::pi / 180;
            std::string row;
            add(row, water.wavelengths_nm[band]);
            add(row, angle);
            add(row, water.uniform.vsf(band, psi));
            for (std::size_t part = 0; part < water.uniform.parts.size(); ++part)
                add(row, water.uniform.vsf(band, part, psi));
            for (const CoefficientTable& constituent : water.constituents)
                add(row, constituent.vsf(band, psi));
            out += row + "\n";
        }
    return out;
}

namespace {

template <class F>
Json list(std::size_t count, F value) {
    Json out = Json::array();
    for (std::size_t i = 0; i < count; ++i) out.push_back(number_json(value(i)));
    return out;
}

Json coefficients(const CoefficientTable& table) {
    const std::size_t n = table.absorption.size();
    Json out;
    if (!table.unit.empty()) {
        out["name"] = table.name;
        out["unit"] = table.unit;
    }
    out["a"] = list(n, [&](std::size_t i) { return table.absorption[i]; });
    out["b"] = list(n, [&](std::size_t i) { return table.scattering(i); });
    out["c"] = list(n, [&](std::size_t i) { return table.attenuation(i); });
    out["bb"] = list(n, [&](std::size_t i) { return table.backscattering(i); });
    out["bb_over_b"] = list(n, [&](std::size_t i) { return table.backscatter_fraction(i); });
    out["albedo"] = list(n, [&](std::size_t i) { return table.albedo(i); });
    out["mean_cosine"] = list(n, [&](std::size_t i) { return table.mean_cosine(i); });
    out["components"] = Json::array();
    for (const ScatteringPart& part : table.parts)
        out["components"].push_back({{"name", part.name},
                                     {"phase_function", part.phase->description()},
                                     {"b", part.b},
                                     {"bb_over_b", part.backscatter_fraction},
                                     {"mean_cosine", part.mean_cosine}});
    return out;
}

Json vsf_json(const WaterReport& report, std::size_t band) {
    const std::vector<double>& angles = file_angles();
    const auto over_angle = [&](auto value) {
        return list(angles.size(),
                    [&](std::size_t i) { return value(angles[i] * std::numbers::pi / 180); });
    };
    const CoefficientTable& uniform = report.table.uniform;
    Json out;
    out["wavelength_nm"] = report.table.wavelengths_nm[band];
    out["total"] = over_angle([&](double psi) { return uniform.vsf(band, psi); });
    // Lists in the order of `components` and `constituents`: names need not be unique.
    out["components"] = Json::array();
    for (std::size_t part = 0; part < uniform.parts.size(); ++part)
        out["components"].push_back(
            over_angle([&](double psi) { return uniform.vsf(band, part, psi); }));
    out["constituents"] = Json::array();
    for (const CoefficientTable& constituent : report.table.constituents)
        out["constituents"].push_back(
            over_angle([&](double psi) { return constituent.vsf(band, psi); }));
    return out;
}

}  // namespace

std::string water_json(const WaterReport& report) {
    const WaterTable& water = report.table;
    Json json;
    json["uwvdb"] = program_version();
    json["water"] = report.title;
    json["sources"] = report.sources;
    json["warnings"] = water.warnings;
    json["units"] = {{"coefficients", "1/m; of constituents 1/m per unit of concentration"},
                     {"vsf", "1/(m sr); of constituents per unit of concentration"},
                     {"attenuation_length", "m"},
                     {"angles", "degrees; 0 is forward"}};
    json["wavelengths_nm"] = water.wavelengths_nm;
    json["small_ppm"] = water.small_ppm;
    json["large_ppm"] = water.large_ppm;
    json["uniform"] = coefficients(water.uniform);
    json["uniform"]["attenuation_length"] = list(water.wavelengths_nm.size(), [&](std::size_t i) {
        return 1 / water.uniform.attenuation(i);
    });
    json["constituents"] = Json::array();
    for (const CoefficientTable& constituent : water.constituents)
        json["constituents"].push_back(coefficients(constituent));
    json["vsf"]["angles_deg"] = file_angles();
    json["vsf"]["bands"] = Json::array();
    for (const std::size_t band : report.vsf_bands)
        json["vsf"]["bands"].push_back(vsf_json(report, band));
    // Names of grids come from users' files and need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

/// More bands than this are so close that their dots would hide the curve.
constexpr std::size_t k_most_dots = 40;

using CurveValue = std::function<double(const CoefficientTable&, std::size_t)>;

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
                  const CoefficientTable* at_fine, const CurveValue& value) {
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

CurveValue b_of_part(std::size_t part) {
    return [part](const CoefficientTable& t, std::size_t i) { return t.parts[part].b[i]; };
}

const CurveValue k_a = [](const CoefficientTable& t, std::size_t i) { return t.absorption[i]; };
const CurveValue k_b = [](const CoefficientTable& t, std::size_t i) { return t.scattering(i); };
const CurveValue k_c = [](const CoefficientTable& t, std::size_t i) { return t.attenuation(i); };
const CurveValue k_bb = [](const CoefficientTable& t, std::size_t i) {
    return t.backscattering(i);
};

PlotPanel coefficient_panel(const WaterReport& report, const FineCurves& fine) {
    PlotPanel panel = spectral_panel(report, "Coefficients", "coefficient [1/m]");
    const CoefficientTable* const table = &fine.table.uniform;
    const auto add = [&](const char* label, LineStyle style, bool known, const CurveValue& value) {
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
