#pragma once

#include <array>
#include <span>

#include "cli/validate/light_check.h"
#include "cli/validate/validation.h"

namespace uw {

/// Radiance in an infinite uniform medium with a point lamp of 1 W/sr: c = 1/m, albedo 0.8, phase
/// function of Henyey and Greenstein with g = 0.9. Light that was not scattered is left out.
struct LampTableRow {
    double distance = 0;             // from the lamp [m]
    double angle = 0;                // between the viewing direction and that to the lamp [degrees]
    std::array<double, 4> orders{};  // scattered once to four times [W m^-2 sr^-1]
    double total = 0;                // scattered any number of times
};

/// Some rows of tests/data/multiple/point_lamp_hg09_albedo08_radiance.csv: successive orders by
/// quadrature, converged to 1e-6.
std::span<const LampTableRow> lamp_table();

/// Compares light paths with `table`, order by order. Throws Interrupted.
LightValidation validate_by_table(std::span<const LampTableRow> table,
                                  const ValidationOptions& options);

}  // namespace uw
