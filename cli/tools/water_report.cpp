#include "cli/tools/water_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/base/json.h"
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

using CurveValue = std::function<double(const CoefficientTable&, std::size_t)>;

const CurveValue k_a = [](const CoefficientTable& t, std::size_t i) { return t.absorption[i]; };
const CurveValue k_b = [](const CoefficientTable& t, std::size_t i) { return t.scattering(i); };
const CurveValue k_c = [](const CoefficientTable& t, std::size_t i) { return t.attenuation(i); };
const CurveValue k_bb = [](const CoefficientTable& t, std::size_t i) {
    return t.backscattering(i);
};

/// One quantity at some wavelengths or angles, under the names that it has in JSON, in text, and in
/// CSV files.
struct Column {
    std::string key, label, unit, csv;
    std::vector<double> values;
};
using Columns = std::vector<Column>;

void append(Columns& columns, const Columns& more) {
    columns.insert(columns.end(), more.begin(), more.end());
}

/// Unit of a coefficient per unit of concentration: "[1/m]", "[1/m per ppm]", "[1/m per unit]".
std::string per(const std::string& coefficient, const CoefficientTable& table) {
    if (table.unit.empty()) return fmt::format("[{}]", coefficient);
    return fmt::format("[{} per {}]", coefficient, table.unit == "1" ? "unit" : table.unit);
}

/// "_per_m", "_per_m_per_ppm", "_per_m_per_unit".
std::string unit_suffix(const CoefficientTable& table, const std::string& per) {
    if (table.unit.empty()) return per;
    return per + (table.unit == "1" ? "_per_unit" : "_per_" + table.unit);
}

/// The coefficients of one table, and their ratios.
Columns coefficient_columns(const CoefficientTable& table) {
    const std::string before = table.name.empty() ? "" : table.name + "_";
    const std::string unit = per("1/m", table), suffix = unit_suffix(table, "_per_m");
    Columns columns;
    const auto add = [&](const std::string& key, const char* label, bool is_ratio,
                         const CurveValue& value) {
        columns.push_back(
            {key, label, is_ratio ? "" : unit, before + key + (is_ratio ? "" : suffix), {}});
        for (std::size_t i = 0; i < table.absorption.size(); ++i)
            columns.back().values.push_back(value(table, i));
    };
    add("a", "a", false, k_a);
    add("b", "b", false, k_b);
    add("c", "c", false, k_c);
    add("bb", "b_b", false, k_bb);
    add("bb_over_b", "b_b/b", true,
        [](const auto& t, auto i) { return t.backscatter_fraction(i); });
    add("albedo", "b/c", true, [](const auto& t, auto i) { return t.albedo(i); });
    add("mean_cosine", "<cos psi>", true, [](const auto& t, auto i) { return t.mean_cosine(i); });
    const double grams = table.grams_per_unit;
    if (!(grams > 0)) return columns;
    const auto add_by_mass = [&](const std::string& key, const char* label,
                                 const CurveValue& value) {
        columns.push_back({key, label, "[m2/g]", before + key + "_m2_per_g", {}});
        for (std::size_t i = 0; i < table.absorption.size(); ++i)
            columns.back().values.push_back(value(table, i) / grams);
    };
    add_by_mass("a_mass", "a/mass", k_a);
    add_by_mass("b_mass", "b/mass", k_b);
    add_by_mass("bb_mass", "b_b/mass", k_bb);
    return columns;
}

Column wavelength_column(const WaterTable& water) {
    return {"", "band", "[nm]", "wavelength_nm", water.wavelengths_nm};
}

Column attenuation_length_column(const CoefficientTable& table) {
    Column column{"attenuation_length", "1/c", "[m]", "attenuation_length_m", {}};
    for (std::size_t i = 0; i < table.absorption.size(); ++i)
        column.values.push_back(1 / table.attenuation(i));
    return column;
}

Columns part_columns(const CoefficientTable& table) {
    Columns columns;
    for (const ScatteringPart& part : table.parts)
        columns.push_back(
            {"", "b " + part.name, per("1/m", table), "b_" + part.name + "_per_m", part.b});
    return columns;
}

/// The scattering function of the water everywhere at some angles [deg], that of its components,
/// and what grids add.
struct VsfColumns {
    Column total;
    Columns parts, constituents;
};

VsfColumns vsf_columns(const WaterTable& water, std::size_t band,
                       const std::vector<double>& angles) {
    const auto values = [&](const auto& beta) {
        std::vector<double> list;
        for (const double angle : angles) list.push_back(beta(angle * std::numbers::pi / 180));
        return list;
    };
    const CoefficientTable& uniform = water.uniform;
    const char* const unit = "[1/(m sr)]";
    VsfColumns columns{{"", "total", unit, "total_per_m_per_sr",
                        values([&](double psi) { return uniform.vsf(band, psi); })},
                       {},
                       {}};
    for (std::size_t part = 0; part < uniform.parts.size(); ++part) {
        const std::string& name = uniform.parts[part].name;
        columns.parts.push_back({"", name, unit, name + "_per_m_per_sr",
                                 values([&](double psi) { return uniform.vsf(band, part, psi); })});
    }
    for (const CoefficientTable& constituent : water.constituents)
        columns.constituents.push_back(
            {"", constituent.name + "*", per("1/(m sr)", constituent),
             constituent.name + unit_suffix(constituent, "_grid_per_m_per_sr"),
             values([&](double psi) { return constituent.vsf(band, psi); })});
    return columns;
}

/// Names, units, and a row for each value of the first column, which has the digits given.
std::string columns_text(const Columns& columns) {
    std::vector<std::vector<std::string>> rows(2 + columns[0].values.size());
    for (const Column& column : columns) {
        const int digits = &column == &columns[0] ? 8 : 4;
        rows[0].push_back(column.label);
        rows[1].push_back(column.unit);
        for (std::size_t i = 0; i < column.values.size(); ++i) {
            const double value = column.values[i];
            rows[2 + i].push_back(std::isfinite(value) ? fmt::format("{:.{}g}", value, digits)
                                                       : "-");
        }
    }
    constexpr std::size_t k_narrowest = 9;
    return fmt::format("{}", fmt::join(aligned_rows(rows, 0, k_narrowest), "\n"));
}

Report report_on_coefficients(const std::string& heading, const WaterTable& water,
                              const CoefficientTable& table) {
    Report report(heading);
    const bool is_uniform = table.unit.empty();
    if (is_uniform && table.parts.size() == 1)
        report.say(fmt::format("(all scattering is that of: {})", table.parts[0].name));
    if (!is_uniform) report.set({{"name", table.name}, {"unit", table.unit}});
    Columns columns = coefficient_columns(table);
    for (const Column& column : columns) report.set({{column.key, list_json(column.values)}});
    Json parts = Json::array();
    for (const ScatteringPart& part : table.parts) {
        // One value, or one for each wavelength.
        const auto moment = [&](double MeasuredPhase::*value) {
            if (part.phases.size() == 1) return Json(part.phases.front().*value);
            Json list = Json::array();
            for (const MeasuredPhase& phase : part.phases)
                list.push_back(phase.phase ? Json(phase.*value) : Json(nullptr));
            return list;
        };
        const MeasuredPhase& phase = *std::ranges::find_if(
            part.phases, [](const MeasuredPhase& other) { return other.phase != nullptr; });
        parts.push_back({{"name", part.name},
                         {"phase_function", phase.phase->description()},
                         {"b", part.b},
                         {"bb_over_b", moment(&MeasuredPhase::backscatter_fraction)},
                         {"mean_cosine", moment(&MeasuredPhase::mean_cosine)}});
    }
    report.set({{"components", std::move(parts)}});
    if (is_uniform) {
        columns.push_back(attenuation_length_column(table));
        report.set({{columns.back().key, list_json(columns.back().values)}});
    }
    if (table.parts.size() > 1) append(columns, part_columns(table));
    columns.insert(columns.begin(), wavelength_column(water));
    report.say(columns_text(columns));
    return report;
}

/// What changes with depth; at many wavelengths in JSON alone.
Report report_on_depths(const WaterTable& water) {
    Report report;
    report.set({{"depths_m", list_json(water.depths)},
                {"a", water.absorption_at},
                {"b", water.scattering_at}});
    constexpr std::size_t k_max_printed = 4;
    if (water.depths.empty()) return report;
    if (water.wavelengths_nm.size() > k_max_printed) return report;
    Columns columns{{"", "depth", "[m]", "", water.depths}};
    for (std::size_t band = 0; band < water.wavelengths_nm.size(); ++band) {
        const std::string nm = fmt::format(" {:g}", water.wavelengths_nm[band]);
        Column a{"", "a" + nm, "[1/m]", "", {}}, b{"", "b" + nm, "[1/m]", "", {}};
        for (std::size_t i = 0; i < water.depths.size(); ++i) {
            a.values.push_back(water.absorption_at[i][band]);
            b.values.push_back(water.scattering_at[i][band]);
        }
        columns.push_back(std::move(a));
        columns.push_back(std::move(b));
    }
    report.say("\nBy depth, linear in between and held above and below:");
    report.say(columns_text(columns));
    return report;
}

Report report_on_vsf(const WaterTable& water, std::size_t band) {
    Report report(
        fmt::format("\nVolume scattering function beta(psi) at {:g} nm; psi is the change of "
                    "direction: 0 forward, 180 backward",
                    water.wavelengths_nm[band]));
    const VsfColumns printed = vsf_columns(water, band, printed_angles());
    Columns columns{{"", "psi", "[deg]", "", printed_angles()}, printed.total};
    if (printed.parts.size() > 1) append(columns, printed.parts);
    append(columns, printed.constituents);
    report.say(columns_text(columns));

    const VsfColumns all = vsf_columns(water, band, file_angles());
    // Lists in the order of the tables' components and constituents: names need not be unique.
    const auto lists = [](const Columns& of) {
        Json json = Json::array();
        for (const Column& column : of) json.push_back(list_json(column.values));
        return json;
    };
    report.set({{"wavelength_nm", water.wavelengths_nm[band]},
                {"total", list_json(all.total.values)},
                {"components", lists(all.parts)},
                {"constituents", lists(all.constituents)}});
    return report;
}

}  // namespace

Report report_on_water(const WaterSurvey& survey) {
    const WaterTable& water = survey.table;
    Report report;
    report.say(survey.title);
    for (const std::string& line : survey.sources) report.say("  " + line);
    report.set({{"uwvdb", program_version()},
                {"water", survey.title},
                {"sources", survey.sources},
                {"warnings", water.warnings},
                {"units",
                 {{"coefficients", "1/m; of constituents 1/m per unit of concentration"},
                  {"vsf", "1/(m sr); of constituents per unit of concentration"},
                  {"attenuation_length", "m"},
                  {"angles", "degrees; 0 is forward"}}},
                {"wavelengths_nm", water.wavelengths_nm},
                {"small_ppm", water.small_ppm},
                {"large_ppm", water.large_ppm}});
    report.add("uniform", report_on_coefficients("\nCoefficients of the water everywhere: "
                                                 "absorption a, scattering b, attenuation c = a + "
                                                 "b, backscattering b_b",
                                                 water, water.uniform));
    std::vector<Report> constituents, bands;
    for (const CoefficientTable& constituent : water.constituents) {
        const bool is_species = std::ranges::find(survey.water.species, constituent.name,
                                                  &SpeciesDesc::name) != survey.water.species.end();
        constituents.push_back(report_on_coefficients(
            fmt::format("\n{} '{}', per {}",
                        is_species ? "Species" : "What grids add:", constituent.name,
                        constituent.unit == "1" ? "unit of the grid's value" : constituent.unit),
            water, constituent));
    }
    report.add("constituents", constituents);
    report.add("profile", report_on_depths(water));
    Report vsf;
    vsf.set({{"angles_deg", file_angles()}});
    for (const std::size_t band : survey.vsf_bands) bands.push_back(report_on_vsf(water, band));
    vsf.add("bands", bands);
    report.add("vsf", vsf);
    return report;
}

namespace {

/// A field of RFC 4180. Names come from users' files.
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

std::string csv_header(const WaterSurvey& survey, const std::string& what, const Columns& columns) {
    std::string comment = fmt::format("# {}: {}", survey.title, what);
    for (const std::string& source : survey.sources) comment += " | " + source;
    for (char& c : comment)
        if (c == '\n' || c == '\r') c = ' ';
    std::vector<std::string> names;
    for (const Column& column : columns) names.push_back(field(column.csv));
    return fmt::format("{} | uwvdb {}\n{}\n", comment, program_version(), fmt::join(names, ","));
}

std::string csv_rows(const Columns& columns) {
    std::string out;
    for (std::size_t i = 0; i < columns[0].values.size(); ++i)
        for (const Column& column : columns) {
            if (&column != &columns[0]) out += ',';
            if (std::isfinite(column.values[i])) out += fmt::format("{:.9g}", column.values[i]);
            if (&column == &columns.back()) out += '\n';
        }
    return out;
}

}  // namespace

std::string water_coefficients_csv(const WaterSurvey& survey) {
    const WaterTable& water = survey.table;
    Columns columns{wavelength_column(water)};
    append(columns, coefficient_columns(water.uniform));
    columns.push_back(attenuation_length_column(water.uniform));
    append(columns, part_columns(water.uniform));
    for (const CoefficientTable& constituent : water.constituents)
        append(columns, coefficient_columns(constituent));
    return csv_header(survey,
                      "coefficients of the water everywhere, then of what has a concentration, per "
                      "unit of it",
                      columns) +
           csv_rows(columns);
}

std::string water_vsf_csv(const WaterSurvey& survey) {
    const WaterTable& water = survey.table;
    std::string out;
    for (const std::size_t band : survey.vsf_bands) {
        const VsfColumns vsf = vsf_columns(water, band, file_angles());
        Columns columns{
            wavelength_column(water), {"", "psi", "[deg]", "angle_deg", file_angles()}, vsf.total};
        columns[0].values.assign(file_angles().size(), water.wavelengths_nm[band]);
        append(columns, vsf.parts);
        append(columns, vsf.constituents);
        if (out.empty())
            out = csv_header(survey,
                             "volume scattering function of the water everywhere and of its "
                             "components, then of what has a concentration",
                             columns);
        out += csv_rows(columns);
    }
    return out;
}

namespace {

/// More bands than this are so close that their dots would hide the curve.
constexpr std::size_t k_max_dots = 40;

struct LineStyle {
    const char* colour;
    const char* dashes;
};

/// The hues of the paper's figure 4: total magenta, water red, small green, large blue.
LineStyle style_of(const std::string& part, std::size_t index = 0) {
    if (part == "total") return {plot_colour::k_purple, ""};
    if (part == "water") return {plot_colour::k_red, "8 3"};
    if (part == "small") return {plot_colour::k_green, "2 2.5"};
    if (part == "large") return {plot_colour::k_blue, "9 3 2 3"};
    // Others by their place, since there may be several.
    static constexpr std::array<LineStyle, 3> k_others{{{plot_colour::k_orange, "5 2"},
                                                        {plot_colour::k_sky, "7 2 2 2"},
                                                        {plot_colour::k_black, "3 3"}}};
    return k_others[index % k_others.size()];
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
std::pair<double, double> plotted_range(const WaterSurvey& survey) {
    const std::vector<double>& bands = survey.table.wavelengths_nm;
    const auto [low, high] = std::minmax_element(bands.begin(), bands.end());
    return {std::floor(std::min(400.0, *low)), std::ceil(std::max(700.0, *high))};
}

FineCurves fine_curves(const WaterSurvey& survey) {
    // Species take too long for that many wavelengths.
    const bool has_species = !survey.water.amounts.empty() || survey.water.profile;
    FineCurves fine{
        {}, !survey.water.absorption && !has_species, !survey.water.scattering && !has_species};
    WaterDesc water = survey.water;
    water.absorption.reset();
    water.scattering.reset();
    water.amounts.clear();
    water.species.clear();
    water.profile.reset();
    std::vector<VolumeDesc> volumes = survey.volumes;
    for (VolumeDesc& volume : volumes)
        std::erase_if(volume.grids, [](const GridMappingDesc& grid) {
            return grid.optics.has_value() || !grid.amounts.empty();
        });
    const WavelengthRange known = pure_water_absorption_range();
    const double first = std::max(known.first_nm, plotted_range(survey).first);
    const double last = std::min(known.last_nm, plotted_range(survey).second);
    water.bands_nm.clear();
    for (double nm = first; nm <= last; nm += 2) water.bands_nm.push_back(nm);
    fine.table = tabulate_water(water, volumes);
    return fine;
}

PlotPanel spectral_panel(const WaterSurvey& survey, const std::string& title,
                         const std::string& y_label) {
    PlotPanel panel{title, {"wavelength [nm]", {}}, {y_label, {}}, {}};
    const auto [first, last] = plotted_range(survey);
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
        if (dots.x.size() > k_max_dots) return;
        dots.label.clear();
    }
    panel.curves.push_back(std::move(dots));
}

CurveValue b_of_part(std::size_t part) {
    return [part](const CoefficientTable& t, std::size_t i) { return t.parts[part].b[i]; };
}

PlotPanel coefficient_panel(const WaterSurvey& survey, const FineCurves& fine) {
    PlotPanel panel = spectral_panel(survey, "Coefficients", "coefficient [1/m]");
    const CoefficientTable* const table = &fine.table.uniform;
    const auto add = [&](const char* label, LineStyle style, bool known, const CurveValue& value) {
        add_spectrum(panel, label, style, survey.table, survey.table.uniform, fine.table,
                     known ? table : nullptr, value);
    };
    add("c = a + b", {plot_colour::k_black, ""}, fine.absorption && fine.scattering, k_c);
    add("a", {plot_colour::k_blue, "8 3"}, fine.absorption, k_a);
    add("b", {plot_colour::k_red, "2 2.5"}, fine.scattering, k_b);
    add("b_b", {plot_colour::k_orange, "9 3 2 3"}, fine.scattering, k_bb);
    return panel;
}

PlotPanel scattering_panel(const WaterSurvey& survey, const FineCurves& fine) {
    PlotPanel panel = spectral_panel(survey, "Scattering by component", "b [1/m]");
    const CoefficientTable& uniform = survey.table.uniform;
    const bool split = uniform.parts.size() != 1;
    const CoefficientTable* const table = fine.scattering ? &fine.table.uniform : nullptr;
    if (split)
        add_spectrum(panel, "total", style_of("total"), survey.table, uniform, fine.table, table,
                     k_b);
    for (std::size_t part = 0; part < uniform.parts.size(); ++part)
        add_spectrum(panel, uniform.parts[part].name, style_of(uniform.parts[part].name, part),
                     survey.table, uniform, fine.table, table, b_of_part(part));
    return panel;
}

/// What grids add, and species; particles are known at all wavelengths, a grid's own coefficients
/// at the bands.
PlotPanel constituent_panel(const WaterSurvey& survey, const FineCurves& fine) {
    PlotPanel panel = spectral_panel(survey, "Concentrations: attenuation", "c* [1/m per unit]");
    for (std::size_t k = 0; k < survey.table.constituents.size(); ++k) {
        const CoefficientTable& constituent = survey.table.constituents[k];
        const CoefficientTable* known = nullptr;
        for (const CoefficientTable& other : fine.table.constituents)
            if (constituent.unit == "ppm" && other.name == constituent.name) known = &other;
        add_spectrum(panel,
                     fmt::format("{} (per {})", constituent.name,
                                 constituent.unit == "1" ? "grid unit" : constituent.unit),
                     style_of(k), survey.table, constituent, fine.table, known, k_c);
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

PlotPanel vsf_panel(const WaterSurvey& survey, AxisScale scale) {
    const std::size_t band = survey.plot_band;
    const CoefficientTable& uniform = survey.table.uniform;
    PlotPanel panel = angular_panel(
        fmt::format("Volume scattering function at {:g} nm{}", survey.table.wavelengths_nm[band],
                    scale == AxisScale::log ? ", log-log" : ""),
        "β [1/(m sr)]", scale);
    if (uniform.parts.size() != 1)
        add_angular(panel, "total", style_of("total"), 3,
                    [&](double psi) { return uniform.vsf(band, psi); });
    for (std::size_t part = 0; part < uniform.parts.size(); ++part)
        add_angular(panel, uniform.parts[part].name, style_of(uniform.parts[part].name, part), 1.8,
                    [&](double psi) { return uniform.vsf(band, part, psi); });
    return panel;
}

PlotPanel constituent_vsf_panel(const WaterSurvey& survey) {
    const std::size_t band = survey.plot_band;
    PlotPanel panel = angular_panel(
        fmt::format("Concentrations: VSF at {:g} nm", survey.table.wavelengths_nm[band]),
        "β* [1/(m sr) per unit]", AxisScale::log);
    for (std::size_t k = 0; k < survey.table.constituents.size(); ++k) {
        const CoefficientTable& constituent = survey.table.constituents[k];
        add_angular(panel, constituent.name, style_of(k), 1.8,
                    [&](double psi) { return constituent.vsf(band, psi); });
    }
    return panel;
}

}  // namespace

PlotFigure water_figure(const WaterSurvey& survey) {
    const FineCurves fine = fine_curves(survey);
    PlotFigure figure;
    figure.title = "Water: " + survey.title;
    figure.caption = survey.sources;
    figure.panels = {coefficient_panel(survey, fine), scattering_panel(survey, fine),
                     vsf_panel(survey, AxisScale::linear), vsf_panel(survey, AxisScale::log)};
    if (!survey.table.constituents.empty()) {
        figure.panels.push_back(constituent_panel(survey, fine));
        figure.panels.push_back(constituent_vsf_panel(survey));
    }
    return figure;
}

}  // namespace uw
