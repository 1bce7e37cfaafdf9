#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/spectrum.h"
#include "core/optics/phase_function.h"

namespace uw {

/// Inherent optical properties, absolute or per unit of concentration: a(lambda) and, for each
/// phase function m of the medium, its scattering coefficient b_m(lambda). [1/m], or [1/m per ppm],
/// or [1/m per unit of grid value].
struct OpticalCoefficients {
    Spectrum absorption{};
    std::vector<Spectrum> scattering;  // one per Medium::phase_functions

    /// c = a + sum_m b_m in band `band`.
    double attenuation(std::size_t band) const {
        double c = absorption[band];
        for (const Spectrum& b : scattering) c += b[band];
        return c;
    }
    /// The same for every band.
    Spectrum attenuation() const {
        Spectrum c = absorption;
        for (const Spectrum& b : scattering) c += b;
        return c;
    }
    /// sum_m b_m for every band.
    Spectrum total_scattering() const {
        Spectrum sum;
        for (const Spectrum& b : scattering) sum += b;
        return sum;
    }
};

/// A dissolved or suspended constituent whose concentration varies in space.
struct Constituent {
    std::string name;              // "small", "large", or the name of a grid with its own optics
    std::string unit;              // "ppm" by volume, or "1" for a bare grid value
    OpticalCoefficients per_unit;  // per unit of concentration
};

/// The optical properties of a scene's water. Every coefficient is linear in the concentrations
/// (physics section 1): X(x) = uniform.X + sum_k nu_k(x) constituents[k].per_unit.X.
struct Medium {
    std::vector<double> wavelengths_nm;  // the bands
    std::vector<std::shared_ptr<const PhaseFunction>> phase_functions;
    OpticalCoefficients uniform;            // water and everything else that is homogeneous
    std::vector<Constituent> constituents;  // contributed by the grids

    int band_count() const { return static_cast<int>(wavelengths_nm.size()); }
    int constituent_count() const { return static_cast<int>(constituents.size()); }
    int phase_count() const { return static_cast<int>(phase_functions.size()); }
};

}  // namespace uw
