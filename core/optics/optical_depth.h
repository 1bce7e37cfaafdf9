#pragma once

#include <cmath>
#include <span>

#include "core/optics/medium.h"

namespace uw {

/// Attenuation coefficients of a medium, laid out for the integrators' inner loops.
struct AttenuationTable {
    Spectrum uniform{};                  // c_0 [1/m]
    std::vector<Spectrum> constituents;  // c* per constituent [1/m per unit]
    int band_count = 0;

    explicit AttenuationTable(const Medium& medium);

    /// tau = c_0 length + sum_k N_k c*_k (physics section 1) for band `band`.
    double optical_depth(std::size_t band, double length, std::span<const double> columns) const {
        double tau = uniform[band] * length;
        for (std::size_t k = 0; k < constituents.size(); ++k)
            tau += constituents[k][band] * columns[k];
        return tau;
    }
    /// e^-tau of every band.
    Spectrum transmittance(double length, std::span<const double> columns) const;
};

}  // namespace uw
