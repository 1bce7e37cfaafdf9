#pragma once

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <memory>

#include "core/light/medium.h"
#include "tests/support/described_phase.h"

namespace uw::test {

inline OpticalCoefficients one_phase_coefficients(std::initializer_list<double> absorption,
                                                  std::initializer_list<double> scattering) {
    OpticalCoefficients coefficients;
    coefficients.scattering.resize(1);
    std::ranges::copy(absorption, coefficients.absorption.begin());
    std::ranges::copy(scattering, coefficients.scattering[0].begin());
    return coefficients;
}

/// Water with one Henyey-Greenstein phase function; coefficients [1/m] by band.
inline Medium hg_medium(double g, std::initializer_list<double> absorption,
                        std::initializer_list<double> scattering) {
    Medium medium;
    for (std::size_t b = 0; b < absorption.size(); ++b)
        medium.wavelengths_nm.push_back(550 - 50 * static_cast<double>(b));
    medium.phase_functions = {henyey_greenstein(g)};
    medium.uniform = one_phase_coefficients(absorption, scattering);
    return medium;
}

/// Adds particles with the same phase function; coefficients [1/m] per ppm by band.
inline void add_particles(Medium& medium, std::initializer_list<double> absorption,
                          std::initializer_list<double> scattering) {
    medium.constituents.push_back({"small", "ppm", one_phase_coefficients(absorption, scattering)});
}

}  // namespace uw::test
