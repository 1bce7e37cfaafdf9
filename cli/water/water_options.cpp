#include <memory>
#include <optional>
#include <string>

#include "cli/band_list.h"
#include "cli/command_options.h"

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

struct Parsed {
    WaterArguments arguments;
    std::optional<std::string> bands;
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
                if (p->bands) a.bands_nm = parse_bands(*p->bands);
                return a;
            }};
}

}  // namespace uw
