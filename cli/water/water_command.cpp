#include "cli/water/water_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <ostream>

#include "cli/console.h"
#include "cli/text_files.h"
#include "cli/water/water_csv.h"
#include "cli/water/water_json.h"
#include "cli/water/water_plot.h"
#include "cli/water/water_text.h"
#include "core/base/error.h"
#include "core/scene/yaml/scene_reader.h"
#include "media/water/jerlov.h"
#include "media/water/water_sources.h"

namespace uw {

namespace {

/// The wavelength of Kopelevich's tables and of the paper's figure 4.
constexpr double k_reference_nm = 550;

bool same_ignoring_case(const std::string& a, const std::string& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](unsigned char x, unsigned char y) {
        return std::tolower(x) == std::tolower(y);
    });
}

/// The preset called `subject`; "" if there is none.
std::string preset_called(const std::string& subject) {
    for (const std::string& name : jerlov_preset_names())
        if (same_ignoring_case(name, subject)) return name;
    return "";
}

/// Fills in title, water and volumes.
void read_subject(const WaterArguments& a, WaterReport& report) {
    const std::string preset = preset_called(a.subject);
    if (a.subject.empty() || !preset.empty()) {
        std::vector<std::string> overrides = a.overrides;
        if (!preset.empty()) overrides.insert(overrides.begin(), "water.preset=" + preset);
        report.water = read_water_overrides(overrides);
        if (preset.empty())
            report.title = a.overrides.empty() ? "pure sea water" : "sea water";
        else
            report.title = preset;
        for (const std::string& text : a.overrides)
            report.title += (&text == &a.overrides.front() ? " with " : ", ") + text;
        return;
    }
    const std::filesystem::path file = a.subject;
    std::error_code error;
    if (!file.has_extension() && !file.has_parent_path() && !std::filesystem::exists(file, error))
        throw UsageError(
            fmt::format("'{}' is neither a preset nor a scene file; the presets are {}", a.subject,
                        fmt::join(jerlov_preset_names(), ", ")));
    SceneDesc scene = read_scene(file, a.overrides);
    report.title = file.filename().string();
    report.water = std::move(scene.water);
    report.volumes = std::move(scene.volumes);
}

void replace_bands(const WaterArguments& a, WaterReport& report) {
    if (a.bands_nm.empty()) return;
    if (is_given_per_band(report.water, report.volumes))
        throw UsageError(
            "--bands: this scene gives coefficients per band, which say nothing about other bands; "
            "leave --bands out, or give the scene a preset or particles instead");
    report.water.bands_nm = a.bands_nm;
}

/// Chooses the wavelengths of the VSF tables and of the VSF plot.
void choose_vsf_bands(const WaterArguments& a, WaterReport& report) {
    const std::vector<double>& bands = report.table.wavelengths_nm;
    const double wanted = a.band_nm.value_or(k_reference_nm);
    const auto nearest = std::min_element(bands.begin(), bands.end(), [&](double x, double y) {
        return std::abs(x - wanted) < std::abs(y - wanted);
    });
    report.plot_band = static_cast<std::size_t>(nearest - bands.begin());
    if (!a.band_nm) {
        for (std::size_t i = 0; i < bands.size(); ++i) report.vsf_bands.push_back(i);
        return;
    }
    if (std::abs(*nearest - wanted) > 1e-6 * wanted)
        throw UsageError(
            fmt::format("--band {:g}: not one of the bands; the nearest is {:g} nm; "
                        "choose others with --bands",
                        wanted, *nearest));
    report.vsf_bands = {report.plot_band};
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
    WaterReport report;
    read_subject(a, report);
    replace_bands(a, report);
    report.table = tabulate_water(report.water, report.volumes);
    report.sources =
        water_sources(report.water, report.volumes, report.table.small_ppm, report.table.large_ppm);
    choose_vsf_bands(a, report);

    TextFiles files;
    if (!a.csv.empty()) {
        files.add(csv_path(a.csv, "coefficients"), water_coefficients_csv(report));
        files.add(csv_path(a.csv, "vsf"), water_vsf_csv(report));
    }
    if (!a.svg.empty()) files.add(a.svg, svg_document(water_figure(report)));
    for (const std::string& warning : report.table.warnings)
        print_message(fmt::format("warning: {}\n", warning));
    // Files first: whoever reads the tables may stop reading, which ends the program.
    files.commit();
    out << (a.json ? water_json(report) : water_text(report)) << std::flush;
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
