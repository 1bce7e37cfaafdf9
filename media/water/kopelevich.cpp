#include "media/water/kopelevich.h"

#include <cmath>

namespace uw {

double kopelevich_small_scattering(double wavelength_nm) {
    return 1.34 * std::pow(550 / wavelength_nm, 1.7);
}

double kopelevich_large_scattering(double wavelength_nm) {
    return 0.312 * std::pow(550 / wavelength_nm, 0.3);
}

double mineral_mass_absorption(double wavelength_nm) {
    return 0.041 * std::exp(-0.0123 * (wavelength_nm - 443));
}

}  // namespace uw
