#include "cli/water/water_options.h"

#include "cli/water/band_list.h"

namespace uw {

const char* const k_water_examples = R"(Examples:
  uwvdb water                                    pure sea water
  uwvdb water jerlov-II --bands 400:700:10 --csv out/jerlov-II
  uwvdb water --set water.particles='{small: 1, large: 1}' --band 540 --svg vsf.svg
  uwvdb water plume.yaml --set water.preset=jerlov-3C --json

Prints a, b and c [1/m] per band and what is derived from them, then the volume scattering function
by component. --set water.* needs no scene. docs/water.md explains the tables and names their
sources.
Presets: jerlov-IB, jerlov-II, jerlov-III, jerlov-1C, jerlov-3C, jerlov-5C.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

Options water_options(WaterArguments& a) {
    Options options;
    options.text("PRESET|SCENE", "", a.subject,
                 "a preset such as jerlov-II, or a scene file; default: pure sea water");
    options.set(a.overrides);
    options.parsed(
        "--bands", "LIST", [&a](const std::string& text) { a.bands_nm = parse_bands(text); },
        "nm: 620,540,450 or first:last:step, instead of the water's");
    options.number("--band", "NM", a.band_nm, 0, 1e5,
                   "nm: the scattering function at this band only");
    options.path("--csv", "PREFIX", a.csv,
                 "write PREFIX-coefficients.csv and PREFIX-vsf.csv, with finer angles");
    options.path("--svg", "FILE", a.svg,
                 "plot coefficients over wavelength, and scattering over angle");
    options.flag("--json", a.json, "print everything as JSON instead of tables");
    return options;
}

}  // namespace uw
