#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>
#include <string_view>

#include "cli/command_options.h"
#include "core/error.h"

namespace uw {

namespace {

constexpr const char* k_water_examples = R"(Examples:
  uwvdb water                                    pure sea water
  uwvdb water jerlov-II --bands 400:700:10 --csv out/jerlov-II
  uwvdb water --set water.particles='{small: 1, large: 1}' --band 540 --svg vsf.svg
  uwvdb water plume.yaml --set water.preset=jerlov-3C --json

Prints a, b, c and what follows from them per band [1/m], then the volume scattering function by
component. --set water.* needs no scene. docs/water.md explains the tables and names their sources.
Presets: jerlov-IB, jerlov-II, jerlov-III, jerlov-1C, jerlov-3C, jerlov-5C.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

constexpr std::size_t k_most_bands = 2000;

double parse_wavelength(std::string_view text, const std::string& whole) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !(value >= 10 && value <= 1e5))
        throw UsageError(
            fmt::format("--bands: expected nanometres as in 620,540,450 or "
                        "400:700:10, found '{}'",
                        whole));
    return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        parts.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

/// "620,540,450" or "first:last:step".
std::vector<double> parse_bands(const std::string& text) {
    std::vector<double> bands;
    const std::vector<std::string_view> range = split(text, ':');
    if (range.size() == 1) {
        for (const std::string_view part : split(text, ','))
            bands.push_back(parse_wavelength(part, text));
    } else {
        double step = 0;
        if (range.size() == 3) {
            const char* const end = range[2].data() + range[2].size();
            if (const auto [stop, error] = std::from_chars(range[2].data(), end, step);
                error != std::errc() || stop != end)
                step = 0;
        }
        if (!(step > 0))
            throw UsageError(
                fmt::format("--bands: a range is first:last:step in nm, such as "
                            "400:700:10, not '{}'",
                            text));
        const double first = parse_wavelength(range[0], text);
        const double last = parse_wavelength(range[1], text);
        const double count = std::floor((last - first) / step + 1e-9) + 1;
        if (!(count >= 1 && count <= static_cast<double>(k_most_bands)))
            throw UsageError(fmt::format("--bands {}: gives no or more than {} wavelengths", text,
                                         k_most_bands));
        for (int i = 0; i < static_cast<int>(count); ++i) bands.push_back(first + i * step);
    }
    std::vector<double> sorted = bands;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
        throw UsageError(fmt::format("--bands {}: a wavelength is given twice", text));
    if (bands.size() > k_most_bands)
        throw UsageError(fmt::format("--bands: more than {} wavelengths", k_most_bands));
    return bands;
}

struct Parsed {
    WaterArguments arguments;
    std::string bands;
};

}  // namespace

Command add_water_command(CLI::App& app) {
    CLI::App& water =
        *app.add_subcommand("water", "tables and plots of a water's optical properties");
    const auto p = std::make_shared<Parsed>();
    water.add_option("PRESET|SCENE", p->arguments.subject,
                     "jerlov-II, or a scene file; pure sea water if left out");
    add_set_option(water, p->arguments.overrides);
    water.add_option("--bands", p->bands,
                     "nm: 620,540,450 or first:last:step; replaces the water's");
    water.add_option("--band", p->arguments.band_nm,
                     "nm: the scattering function at this band only");
    water
        .add_option("--csv", p->arguments.csv,
                    "write PREFIX-coefficients.csv and PREFIX-vsf.csv, with finer angles")
        ->type_name("PREFIX");
    water.add_option("--svg", p->arguments.svg,
                     "plot coefficients over wavelength, and scattering over angle");
    water.add_flag("--json", p->arguments.json, "print everything as JSON instead of tables");
    water.footer(k_water_examples);
    return {&water, [p]() -> Arguments {
                WaterArguments a = p->arguments;
                if (!p->bands.empty()) a.bands_nm = parse_bands(p->bands);
                return a;
            }};
}

}  // namespace uw
