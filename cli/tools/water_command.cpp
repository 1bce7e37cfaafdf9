#include "cli/tools/water_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <ostream>
#include <string_view>

#include "cli/console.h"
#include "cli/number_range.h"
#include "cli/tools/water_report.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/scene_desc.h"
#include "media/inspection/water_table.h"
#include "media/water/water_types.h"

namespace uw {

namespace {

constexpr int k_max_wavelengths = 2000;

[[noreturn]] void fail(const std::string& text, std::string_view what) {
    throw UsageError(fmt::format("--bands {}: {}", printable(text), what));
}

void check_wavelength(double nm, const std::string& text) {
    if (!(nm >= 10 && nm <= 1e5)) fail(text, "give nanometres, as in 620,540,450 or 400:700:10");
}

std::vector<double> wavelengths_of_range(const std::string& text) {
    const std::optional<NumberRange> range = number_range_in(text);
    if (!range || !(range->step >= 1e-6 && range->step <= 1e5))
        fail(text, "a range is first:last:step in nm, such as 400:700:10");
    check_wavelength(range->first, text);
    check_wavelength(range->last, text);
    if (range->last < range->first)
        fail(text, "the last wavelength is less than the first; swap them");
    const double count = range->count();
    if (count > k_max_wavelengths)
        fail(text, fmt::format("more than {} wavelengths; give a larger step", k_max_wavelengths));
    std::vector<double> bands;
    bands.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < static_cast<int>(count); ++i) bands.push_back(range->at(i));
    return bands;
}

}  // namespace

std::vector<double> parse_bands(const std::string& text) {
    if (text.find(':') != std::string::npos) return wavelengths_of_range(text);
    std::vector<double> bands;
    for (const std::string_view part : split(text, ',')) {
        double nm = 0;  // and stays it if the part is no number
        parse_number(part, nm);
        check_wavelength(nm, text);
        bands.push_back(nm);
    }
    if (bands.size() > static_cast<std::size_t>(k_max_wavelengths))
        fail(text, fmt::format("more than {} wavelengths", k_max_wavelengths));
    std::vector<double> sorted = bands;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
        fail(text, "a wavelength is given twice; remove one");
    return bands;
}

namespace {

const char* const k_water_examples = R"(Examples:
  uwvdb water                                    pure sea water
  uwvdb water jerlov-II --bands 400:700:10 --csv out/jerlov-II
  uwvdb water --set water.particles='{small: 1, large: 1}' --band 540 --svg vsf.svg
  uwvdb water plume.yaml --set water.preset=jerlov-3C --json
  uwvdb water --species clay,silt,petzold-harbor --band 540 --svg species.svg

Prints a, b and c [1/m] per band and what is derived from them, then the volume scattering function
by component. --set water.* needs no scene. docs/water.md explains the tables and names their
sources.
Presets: jerlov-IB, jerlov-II, jerlov-III, jerlov-1C, jerlov-3C, jerlov-5C.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

}  // namespace

Options water_options(WaterArguments& a) {
    Options options;
    options.text("PRESET|SCENE", "", a.subject,
                 "a preset such as jerlov-II, or a scene file; default: pure sea water");
    options.set(a.overrides);
    options.parsed(
        "--species", "LIST",
        [&a](const std::string& text) {
            for (const std::string_view name : split(text, ','))
                a.overrides.push_back(fmt::format("water.species.{}={{library: {}}}", name, name));
        },
        "compare species of the library, such as clay,silt: adds them to water.species");
    options.parsed(
        "--bands", "LIST", [&a](const std::string& text) { a.bands_nm = parse_bands(text); },
        "nm: 620,540,450 or first:last:step, instead of the water's");
    options.number("--band", "NM", a.band_nm, 0, 1e5,
                   "nm: the scattering function at this band only");
    options.output("--csv", "PREFIX", a.csv,
                   "write PREFIX-coefficients.csv and PREFIX-vsf.csv, with finer angles");
    options.output("--svg", "FILE", a.svg,
                   "plot coefficients over wavelength, and scattering over angle");
    options.flag("--json", a.json, "print everything as JSON instead of tables");
    return options;
}

namespace {

/// The wavelength of Kopelevich's tables and of the paper's figure 4.
constexpr double k_reference_nm = 550;

/// The preset called `subject`; "" if there is none.
std::string preset_called(const std::string& subject) {
    for (const std::string& name : jerlov_preset_names())
        if (same_ignoring_case(name, subject)) return name;
    return "";
}

/// Fills in title, water and volumes.
void read_subject(const WaterArguments& a, WaterSurvey& survey) {
    const std::string preset = preset_called(a.subject);
    if (a.subject.empty() || !preset.empty()) {
        std::vector<std::string> overrides = a.overrides;
        if (!preset.empty()) overrides.insert(overrides.begin(), "water.preset=" + preset);
        survey.water = read_water_overrides(overrides);
        if (preset.empty())
            survey.title = a.overrides.empty() ? "pure sea water" : "sea water";
        else
            survey.title = preset;
        for (const std::string& text : a.overrides)
            survey.title += (&text == &a.overrides.front() ? " with " : ", ") + text;
        return;
    }
    const std::filesystem::path file = a.subject;
    std::error_code error;
    if (!file.has_extension() && !file.has_parent_path() && !std::filesystem::exists(file, error))
        throw UsageError(
            fmt::format("'{}' is neither a preset nor a scene file; the presets are {}", a.subject,
                        fmt::join(jerlov_preset_names(), ", ")));
    SceneDesc scene = read_scene(file, a.overrides);
    survey.title = file.filename().string();
    survey.water = std::move(scene.water);
    survey.volumes = std::move(scene.volumes);
}

void replace_bands(const WaterArguments& a, WaterSurvey& survey) {
    if (a.bands_nm.empty()) return;
    if (is_given_per_band(survey.water, survey.volumes))
        throw UsageError(
            "--bands: this scene gives coefficients per band, which say nothing about other bands; "
            "leave --bands out, or give the scene a preset or particles instead");
    survey.water.bands_nm = a.bands_nm;
}

/// Chooses the wavelengths of the VSF tables and of the VSF plot.
void choose_vsf_bands(const WaterArguments& a, WaterSurvey& survey) {
    const std::vector<double>& bands = survey.table.wavelengths_nm;
    const double wanted = a.band_nm.value_or(k_reference_nm);
    const auto nearest = std::min_element(bands.begin(), bands.end(), [&](double x, double y) {
        return std::abs(x - wanted) < std::abs(y - wanted);
    });
    survey.plot_band = static_cast<std::size_t>(nearest - bands.begin());
    if (!a.band_nm) {
        for (std::size_t i = 0; i < bands.size(); ++i) survey.vsf_bands.push_back(i);
        return;
    }
    if (std::abs(*nearest - wanted) > 1e-6 * wanted)
        throw UsageError(
            fmt::format("--band {:g}: not one of the bands; the nearest is {:g} nm; "
                        "choose others with --bands",
                        wanted, *nearest));
    survey.vsf_bands = {survey.plot_band};
}

/// `prefix` with `-tail.csv` appended, without the prefix's own extension .csv if it has one.
std::filesystem::path csv_path(std::filesystem::path prefix, const char* tail) {
    if (prefix.extension() == ".csv") prefix.replace_extension();
    if (!prefix.has_filename())
        throw UsageError("--csv: give the beginning of the files' names, such as out/water");
    prefix += fmt::format("-{}.csv", tail);
    return prefix;
}

}  // namespace

void run_water(const WaterArguments& a, std::ostream& out) {
    WaterSurvey survey;
    read_subject(a, survey);
    replace_bands(a, survey);
    check_outputs({a.svg});
    {
        Progress progress("particles", "", 1, ProgressForm::text);
        survey.table = tabulate_water(survey.water, survey.volumes,
                                      [&](double fraction) { progress.update(fraction); });
    }
    survey.sources =
        water_sources(survey.water, survey.volumes, survey.table.small_ppm, survey.table.large_ppm);
    choose_vsf_bands(a, survey);

    TextFiles files;
    if (!a.csv.empty()) {
        files.add(csv_path(a.csv, "coefficients"), water_coefficients_csv(survey));
        files.add(csv_path(a.csv, "vsf"), water_vsf_csv(survey));
    }
    if (!a.svg.empty()) files.add(a.svg, svg_document(water_figure(survey)));
    for (const std::string& warning : survey.table.warnings)
        print_message(fmt::format("warning: {}\n", warning));
    // Files first: whoever reads the tables may stop reading, which ends the program.
    files.commit();
    out << report_on_water(survey).printed(a.json) << std::flush;
    if (!out) throw IoError("standard output: cannot write; is the disk full?");
}

Command water_command() {
    const auto arguments = std::make_shared<WaterArguments>();
    return {"water", "tables and plots of a water's optical properties", k_water_examples,
            water_options(*arguments), [arguments] {
                run_water(*arguments, std::cout);
                return k_exit_done;
            }};
}

}  // namespace uw
