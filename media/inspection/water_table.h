#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/light/medium.h"
#include "core/scene/volume_desc.h"
#include "core/scene/water_desc.h"

namespace uw {

/// A phase function with its moments.
struct MeasuredPhase {
    std::shared_ptr<const PhaseFunction> phase;
    double backscatter_fraction = 0;  // 2 pi int p sin(psi), 90 to 180 degrees
    double mean_cosine = 0;           // 2 pi int p cos(psi) sin(psi)
};

/// One additive component of scattering: b at each wavelength. Particles of a species have a phase
/// function for each wavelength, the others one for all.
struct ScatteringPart {
    std::string
        name;  // "water", "small", "large", a species; else the phase function's description
    std::vector<MeasuredPhase> phases;  // one, or one per wavelength
    std::vector<double> b;              // per wavelength, in the unit of its CoefficientTable

    const MeasuredPhase& at(std::size_t i) const { return phases[phases.size() > 1 ? i : 0]; }
};

/// Spectral coefficients of the uniform water [1/m], or of a constituent that grids add [1/m per
/// unit of its concentration]. `i` is an index into WaterTable::wavelengths_nm.
struct CoefficientTable {
    std::string name;           // of the constituent; empty for the uniform water
    std::string unit;           // of its concentration (Constituent::unit); else empty
    double grams_per_unit = 0;  // of its concentration [g/m^3]; 0: not known
    std::vector<double> absorption;
    std::vector<ScatteringPart> parts;  // those that scatter at any wavelength

    /// b = sum over the parts.
    double scattering(std::size_t i) const;
    /// c = a + b.
    double attenuation(std::size_t i) const;
    /// b_b, the coefficient of scattering through more than 90 degrees.
    double backscattering(std::size_t i) const;
    /// b_b / b; NaN where nothing scatters.
    double backscatter_fraction(std::size_t i) const;
    /// Mean cosine of the scattering angle; NaN where nothing scatters.
    double mean_cosine(std::size_t i) const;
    /// b / c, the single-scattering albedo; NaN where nothing attenuates.
    double albedo(std::size_t i) const;
    /// beta(psi) of all parts [1/sr of the table's unit] (physics section 1).
    double vsf(std::size_t i, double psi) const;
    /// beta(psi) of one part.
    double vsf(std::size_t i, std::size_t part, double psi) const;
};

/// The optical properties of a scene's water, by wavelength and component.
struct WaterTable {
    std::vector<double> wavelengths_nm;
    CoefficientTable uniform;                    // everything that is homogeneous
    std::vector<CoefficientTable> constituents;  // of the grids, and all species, per unit
    std::vector<double> depths;                  // of the water's profile [m]
    /// Coefficients of all water at these depths [depth][wavelength] [1/m].
    std::vector<std::vector<double>> absorption_at, scattering_at;
    double small_ppm = 0, large_ppm = 0;  // background particles, part of `uniform`
    std::vector<std::string> warnings;    // as in WaterModel
};

/// Whether coefficients of the water or of a grid are given as numbers per band, and are therefore
/// known at the scene's own bands only.
bool is_given_per_band(const WaterDesc& water, const std::vector<VolumeDesc>& volumes);

/// Tabulates the result of build_water_model, to which `progress` is passed, for `water` at
/// `water.bands_nm`, of which there may be more than k_max_bands unless numbers are given per band.
/// Throws as build_water_model.
WaterTable tabulate_water(const WaterDesc& water, const std::vector<VolumeDesc>& volumes,
                          const ProgressCallback& progress = {});

/// 2 pi int p(psi) f(psi) sin(psi) dpsi over [90, 180] degrees with f = 1.
double backscatter_fraction(const PhaseFunction& phase);

/// 2 pi int p(psi) cos(psi) sin(psi) dpsi over [0, 180] degrees.
double mean_cosine(const PhaseFunction& phase);

/// The sources of the water's coefficients, one line each: "absorption: ...", "scattering: ...",
/// and one line per grid that adds to them. `small_ppm` and `large_ppm` are the background
/// particles determined by build_water_model.
std::vector<std::string> water_sources(const WaterDesc& water,
                                       const std::vector<VolumeDesc>& volumes, double small_ppm,
                                       double large_ppm);

}  // namespace uw
