#include "cli/tools/coefficients_command.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/console.h"
#include "cli/image_choice.h"
#include "cli/pages/svg_plot.h"
#include "cli/process.h"
#include "cli/report.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "render/image_scene.h"
#include "render/meters/water_coefficients.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

const char* const k_coefficients_examples = R"(Examples:
  uwvdb coefficients harbour.yaml                     by band, for 12 targets from 0.5 to 10 m
  uwvdb coefficients harbour.yaml --near 0.3 --far 3 --set render.scattering=single
  uwvdb coefficients harbour.yaml --csv beta.csv --svg beta.svg --oceansim water.yaml

Finds the coefficients of the formula that computer vision uses (Akkaynak and Treibitz 2018),

  I = J exp(-beta_D d) + B_inf (1 - exp(-beta_B d)),

from renderings of a white and a black target across the camera's axis at each range d, and of the
water without one: the target's light is white less black, the backscatter black. J is the target
without water. Of lamps it falls off with distance, which is divided out unless --keep-falloff is
given. Renderings are in all light unless render.scattering is single. "here" is what the formula
would need from one range to the next (beta_D) and up to a range (beta_B); "off" is how far it is
from the rendering of a grey target (--reflectance).

J counts the light that comes from lamps and sun straight to the target. What reaches it scattered
makes beta_D smaller, below 0 where daylight that only scatters to the target outlasts the lamps:
--keep-falloff is the better choice there.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.
More: docs/water.md)";

struct CoefficientsArguments {
    std::filesystem::path scene, csv, svg, oceansim;
    std::string camera;
    std::vector<std::string> overrides;
    TargetSeriesOptions targets;
    FormulaOptions formula;
    bool keep_falloff = false;
    std::optional<int> frame;
    int threads = 0;
    bool json = false, quiet = false;
    ProgressForm progress = ProgressForm::text;
};

constexpr double k_longest_range = 1000;  // [m]

Options coefficients_options(CoefficientsArguments& a) {
    Options options;
    options.input("SCENE", "", a.scene, "scene file (docs/scene-file.md)").required = true;
    options.number("--near", "D", a.targets.nearest, 0, k_longest_range,
                   "metres from the camera to the nearest target; default 0.5");
    options.number("--far", "D", a.targets.farthest, 0, k_longest_range,
                   "metres to the farthest; default 10");
    options.integer("--count", "N", a.targets.count, 2, 200,
                    "how many ranges, in equal ratios; default 12");
    options.number("--side", "D", a.targets.side, 0, k_longest_range,
                   "side of the targets in metres; default 0.5");
    options.number("--reflectance", "R", a.formula.reflectance, 0, 1,
                   "of the target for which misfits are stated; default 0.5");
    options.flag("--keep-falloff", a.keep_falloff,
                 "take J as constant, so that beta_D takes over the lamps' fall-off");
    options.text("--camera", "NAME", a.camera, "which camera of a rig");
    options.integer("--frame", "N", a.frame, 0, 999'999'999, "which frame of what moves");
    options.number("--error", "R", a.targets.error, 0, 1,
                   "in all light: the standard error of each rendering; default 0.02");
    options.output("--csv", "FILE", a.csv, "write a row per band and range");
    options.output("--svg", "FILE", a.svg, "plot coefficients and misfit over range");
    options.output("--oceansim", "FILE", a.oceansim,
                   "write the water of OceanSim's camera (UW_yaml_path)");
    options.set(a.overrides);
    options.threads(a.threads);
    options.flag("--json", a.json, "print everything as JSON instead of tables");
    options.messages(a.quiet, a.progress);
    return options;
}

/// A series and what the formula makes of it; none where the light does not tell.
struct FittedSeries {
    const TargetSeries* series;
    std::optional<FormulaFit> fit;
};

std::string number_or_dash(double value, const char* format) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

constexpr double k_tolerance = 0.1;  // misfit from which on the formula is said to break

std::string break_text(const FormulaFit& fit, const std::vector<double>& ranges) {
    const auto breaks = fit.breaks_at(k_tolerance);
    return breaks ? fmt::format("from {:.3g} m", ranges[*breaks]) : "nowhere";
}

Report coefficient_report(const std::string& title, const TargetSeriesSet& set,
                          const std::vector<FittedSeries>& all, const CoefficientsArguments& a) {
    Report report;
    report.say(
        fmt::format("{}: I = J exp(-beta_D d) + B_inf (1 - exp(-beta_B d)), 1/m and W/(m2 "
                    "sr), {} from {:.3g} to {:.3g} m{}",
                    title, counted(set.ranges.size(), "target"), set.ranges.front(),
                    set.ranges.back(), a.keep_falloff ? ", with the lamps' fall-off" : ""));
    report.set({{"scene", a.scene.string()},
                {"ranges_m", set.ranges},
                {"reflectance", a.formula.reflectance},
                {"falloff_divided", !a.keep_falloff},
                {"error", set.error ? Json(*set.error) : Json(nullptr)}});
    std::vector<std::vector<std::string>> rows{
        {"", "c", "beta_D", "beta_B", "B_inf", "J of white", "greatest misfit", "off by 10 %"}};
    std::vector<Report> parts;
    for (const auto& [series, fit] : all) {
        Report part;
        part.set({{"name", series->name},
                  {"c", number_json(series->attenuation)},
                  {"background", series->background},
                  {"signal", series->signal},
                  {"backscatter", series->backscatter}});
        if (!fit) {
            rows.push_back({series->name, number_or_dash(series->attenuation, "{:.4g}"), "-", "-",
                            fmt::format("{:.4g}", series->background), "-", "-", "-"});
            part.set({{"beta_D", nullptr}, {"beta_B", nullptr}});
            parts.push_back(std::move(part));
            continue;
        }
        rows.push_back({series->name, number_or_dash(series->attenuation, "{:.4g}"),
                        fmt::format("{:.4g}", fit->beta_d), number_or_dash(fit->beta_b, "{:.4g}"),
                        fmt::format("{:.4g}", fit->background),
                        fmt::format("{:.3g} to {:.3g}", fit->white.front(), fit->white.back()),
                        fmt::format("{:+.1f} %", 100 * fit->worst_misfit()),
                        break_text(*fit, set.ranges)});
        const auto breaks = fit->breaks_at(k_tolerance);
        part.set({{"beta_D", fit->beta_d},
                  {"beta_B", number_json(fit->beta_b)},
                  {"white", list_json(fit->white)},
                  {"beta_D_here", list_json(fit->beta_d_here)},
                  {"beta_B_here", list_json(fit->beta_b_here)},
                  {"misfit", list_json(fit->misfit)},
                  {"breaks_at_m", breaks ? Json(set.ranges[*breaks]) : Json(nullptr)}});
        parts.push_back(std::move(part));
    }
    for (const std::string& row : aligned_rows(rows, 1)) report.say(row);
    rows = {{"d [m]"}};
    for (const auto& [series, fit] : all)
        if (fit)
            for (const char* column : {" beta_D here", " beta_B here", " off"})
                rows[0].push_back(series->name + column);
    for (std::size_t i = 0; i < set.ranges.size(); ++i) {
        std::vector<std::string>& row =
            rows.emplace_back(std::vector{fmt::format("{:.3g}", set.ranges[i])});
        for (const auto& [series, fit] : all) {
            if (!fit) continue;
            row.push_back(
                i < fit->beta_d_here.size() ? number_or_dash(fit->beta_d_here[i], "{:.4g}") : "-");
            row.push_back(number_or_dash(fit->beta_b_here[i], "{:.4g}"));
            row.push_back(std::isfinite(fit->misfit[i])
                              ? fmt::format("{:+.1f} %", 100 * fit->misfit[i])
                              : "-");
        }
    }
    // More columns than a terminal has are for --csv and --json.
    constexpr std::size_t k_max_columns = 1 + 3 * 3;
    if (rows[0].size() <= k_max_columns)
        for (const std::string& row : aligned_rows(rows, 0)) report.say(row);
    if (set.error)
        report.say(fmt::format("standard error of a rendering: up to {:.2g} %", 100 * *set.error));
    report.add("series", parts);
    return report;
}

std::string coefficient_csv(const TargetSeriesSet& set, const std::vector<FittedSeries>& all) {
    std::string text =
        "# light in W/(m2 sr), coefficients in 1/m; beta_D_here up to the next range, beta_B_here "
        "up to this one; signal and white of a target of reflectance 1\n"
        "band,range_m,signal,backscatter,background,white,beta_D,beta_B,beta_D_here,beta_B_here,"
        "misfit\n";
    const auto cell = [](double value) {
        return std::isfinite(value) ? fmt::format(",{:.7g}", value) : std::string(",");
    };
    for (const auto& [series, fit] : all)
        for (std::size_t i = 0; i < set.ranges.size(); ++i) {
            text += fmt::format("{},{:.7g}", series->name, set.ranges[i]);
            text +=
                cell(series->signal[i]) + cell(series->backscatter[i]) + cell(series->background);
            if (fit)
                text += cell(fit->white[i]) + cell(fit->beta_d) + cell(fit->beta_b) +
                        (i < fit->beta_d_here.size() ? cell(fit->beta_d_here[i]) : ",") +
                        cell(fit->beta_b_here[i]) + cell(fit->misfit[i]);
            else
                text += ",,,,,,";
            text += "\n";
        }
    return text;
}

PlotFigure coefficient_figure(const std::string& title, const TargetSeriesSet& set,
                              const std::vector<FittedSeries>& all) {
    constexpr std::array k_colours{plot_colour::k_red,    plot_colour::k_green,
                                   plot_colour::k_blue,   plot_colour::k_orange,
                                   plot_colour::k_purple, plot_colour::k_sky};
    PlotFigure figure;
    figure.title = title;
    figure.caption = {
        "Markers: from renderings; dashed: the formula with one coefficient for all ranges."};
    const std::vector<double>& d = set.ranges;
    std::vector<double> middles;
    for (std::size_t i = 0; i + 1 < d.size(); ++i) middles.push_back(0.5 * (d[i] + d[i + 1]));
    const auto add = [&](const char* name, const char* unit, AxisScale scale, auto&& curves) {
        PlotPanel& panel = figure.panels.emplace_back();
        panel.title = name;
        panel.x = {"range [m]", {}};
        panel.y = {unit, {}};
        panel.y.request.scale = scale;
        for (std::size_t s = 0; s < all.size(); ++s) {
            if (!all[s].fit) continue;
            const auto [x, exact, formula] = curves(*all[s].series, *all[s].fit);
            const std::string colour = k_colours[s % k_colours.size()];
            panel.curves.push_back({.label = all[s].series->name,
                                    .x = x,
                                    .y = exact,
                                    .colour = colour,
                                    .width = formula.empty() ? 1.8 : 0,
                                    .markers = true});
            if (!formula.empty())
                panel.curves.push_back(
                    {.label = "", .x = x, .y = formula, .colour = colour, .dashes = "6 3"});
        }
    };
    using Curves = std::array<std::vector<double>, 3>;
    add("direct light: beta_D", "1/m", AxisScale::linear,
        [&](const TargetSeries&, const FormulaFit& fit) {
            return Curves{middles, fit.beta_d_here, std::vector(middles.size(), fit.beta_d)};
        });
    add("backscatter: beta_B", "1/m", AxisScale::linear,
        [&](const TargetSeries&, const FormulaFit& fit) {
            return Curves{d, fit.beta_b_here, std::vector(d.size(), fit.beta_b)};
        });
    add("white target and backscatter", "W/(m² sr)", AxisScale::log,
        [&](const TargetSeries& series, const FormulaFit& fit) {
            std::vector<double> exact, formula;
            for (std::size_t i = 0; i < d.size(); ++i) {
                exact.push_back(series.signal[i] + series.backscatter[i]);
                formula.push_back(fit.white[i] * std::exp(-fit.beta_d * d[i]) -
                                  fit.background * std::expm1(-fit.beta_b * d[i]));
            }
            return Curves{d, exact, formula};
        });
    add("misfit of the grey target", "%", AxisScale::linear,
        [&](const TargetSeries&, const FormulaFit& fit) {
            std::vector<double> percent;
            for (const double value : fit.misfit) percent.push_back(100 * value);
            return Curves{d, percent, {}};
        });
    return figure;
}

/// The file that OceanSim's UW_Camera reads: its picture is raw exp(-atten_coeff d) + 255
/// backscatter_value (1 - exp(-backscatter_coeff d)), of 8 bits, d the distance to the camera.
std::string oceansim_text(const std::string& title, const TargetSeriesSet& set,
                          const std::vector<FittedSeries>& all) {
    const std::size_t first = all.size() == 3 ? 0 : all.size() - 3;
    if (all.size() < 3 || (all.size() > 3 && all[first].series->name != "R"))
        throw UsageError(
            "--oceansim: the file has red, green and blue; give the scene three bands, or a "
            "render.response");
    std::array<std::string, 3> lists;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::optional<FormulaFit>& fit = all[first + c].fit;
        if (!fit || !std::isfinite(fit->beta_b))
            throw InputError(fmt::format("{}: {} has no coefficients; choose nearer ranges", title,
                                         all[first + c].series->name));
        const double white = fit->white[fit->white.size() / 2];
        const std::array values{fit->background / white, fit->beta_d, fit->beta_b};
        for (std::size_t i = 0; i < 3; ++i)
            lists[i] += fmt::format("{}{:.6g}", c == 0 ? "" : ", ", values[i]);
    }
    return fmt::format(
        "# {}: red, green, blue, in linear light; white is the target at {:.3g} m without water\n"
        "backscatter_value: [{}]\natten_coeff: [{}]\nbackscatter_coeff: [{}]\n",
        title, set.ranges[set.ranges.size() / 2], lists[0], lists[1], lists[2]);
}

void run_coefficients(const CoefficientsArguments& a) {
    if (!(a.targets.nearest < a.targets.farthest))
        throw UsageError(fmt::format("--far: {:g} m is not beyond the nearest target at {:g} m",
                                     a.targets.farthest, a.targets.nearest));
    SceneDesc scene = load_scene(a.scene, a.overrides);
    for (const std::string& warning : scene.warnings)
        print_message(fmt::format("warning: {}\n", warning));
    check_outputs({a.csv, a.svg, a.oceansim});
    const std::string title = a.scene.filename().string();
    const ImageChoice choice{a.frame, chosen_camera(a.camera, scene.cameras)};
    const ImageScene image(std::move(scene), choice);
    Progress progress("coefficients", "", 1, a.progress);
    TargetSeriesSet set;
    with_threads(a.threads, [&] {
        set = measure_targets(image, a.targets, [&](double fraction) {
            if (!a.quiet) progress.update(fraction);
        });
    });
    FormulaOptions formula = a.formula;
    formula.divides_falloff = !a.keep_falloff;
    std::vector<FittedSeries> all;
    bool any = false;
    for (const TargetSeries& series : set.series) {
        all.push_back({&series, fit_formula(set.ranges, series, formula)});
        any = any || all.back().fit;
    }
    if (!any)
        throw InputError(
            title +
            ": lamps: they light the target directly, so that it is seen, at fewer than two "
            "ranges; aim a lamp along the camera's axis, or choose nearer ranges");
    TextFiles files;
    if (!a.csv.empty()) files.add(a.csv, coefficient_csv(set, all));
    if (!a.svg.empty()) files.add(a.svg, svg_document(coefficient_figure(title, set, all)));
    if (!a.oceansim.empty()) files.add(a.oceansim, oceansim_text(title, set, all));
    progress.end_line();
    files.commit(a.quiet);
    print_output(coefficient_report(title, set, all, a).printed(a.json));
}

}  // namespace

Command coefficients_command() {
    const auto arguments = std::make_shared<CoefficientsArguments>();
    return {"coefficients", "find the coefficients of computer vision's formula for a scene",
            k_coefficients_examples, coefficients_options(*arguments), [arguments] {
                install_stop_signal();
                run_coefficients(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
