#pragma once

#include "media/water/pure_water.h"

namespace uw {

/// Absorption by coloured dissolved organic matter [1/m]: a_440 exp(-0.014 (lambda - 440)), with
/// `a_440` its absorption at 440 nm [1/m] (Bricaud, Morel and Prieur 1981).
double cdom_absorption(double wavelength_nm, double a_440);

/// Wavelengths for which chlorophyll's coefficients are tabulated: 400 to 700 nm.
WavelengthRange chlorophyll_absorption_range();

/// Absorption by phytoplankton [1/m] with `chlorophyll` [mg/m^3]: A(lambda) Chl^(1 - B(lambda))
/// (Bricaud et al. 1995), A and B interpolated linearly in 5 nm tables. Outside
/// `chlorophyll_absorption_range()` the value at the nearer end is used, which callers should warn
/// about.
double chlorophyll_absorption(double wavelength_nm, double chlorophyll);

}  // namespace uw
