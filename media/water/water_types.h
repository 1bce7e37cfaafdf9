#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/csv_table.h"
#include "core/base/spectrum.h"
#include "core/scene/water_desc.h"

namespace uw {

// Tests compare each of these formulas with its paper; uniform_absorption combines them to a
// scene's absorption.

/// Wavelengths covered by a table [nm].
struct WavelengthRange {
    double first_nm, last_nm;

    bool contains(double wavelength_nm) const {
        return wavelength_nm >= first_nm && wavelength_nm <= last_nm;
    }
};

/// Wavelengths for which pure water's absorption is known: 300 to 900 nm.
WavelengthRange pure_water_absorption_range();

/// Absorption of pure (sea) water [1/m] at `wavelength_nm`, `temperature` [deg C] and `salinity`
/// [PSU]: the WOPP v3 composite (Roettgers et al. 2016), a(T, S) = a + (T - 20) da/dT + S da/dS,
/// interpolated linearly in its 2 nm table and never below 0. Outside
/// `pure_water_absorption_range()`: InputError.
double pure_water_absorption(double wavelength_nm, double temperature, double salinity);

/// Volume scattering function of water's molecules at 90 degrees [1/(m sr)] (Morel 1974):
/// 1.38e-4 (1 + 0.3 S/37) (500/lambda)^4.32, with `salinity` S in PSU.
double water_vsf_90(double wavelength_nm, double salinity);

/// Scattering coefficient of water's molecules [1/m]: water_vsf_90 integrated over the sphere with
/// MolecularPhase, i.e. times 4 pi (1 + 0.835/3) = 16.064.
double water_scattering(double wavelength_nm, double salinity);

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

/// Scattering coefficient of Kopelevich's small particles [1/m per ppm by volume]:
/// 1.34 (550/lambda)^1.7 (physics section 1).
double kopelevich_small_scattering(double wavelength_nm);

/// Scattering coefficient of Kopelevich's large particles [1/m per ppm by volume]:
/// 0.312 (550/lambda)^0.3.
double kopelevich_large_scattering(double wavelength_nm);

/// Absorption of mineral sediment [m^2/g]: 0.041 exp(-0.0123 (lambda - 443)) (Babin et al. 2003).
/// Multiplied by a density in g/cm^3, it is in [1/m per ppm].
double mineral_mass_absorption(double wavelength_nm);

/// A Jerlov water type with measured inherent optical properties (Williamson and Hollins 2022).
struct JerlovPreset {
    std::string name;          // "jerlov-II"
    WavelengthRange measured;  // wavelengths of the absorption measurements
    SampledCurve
        excess_absorption;        // measured minus pure water's, at the measured wavelengths [1/m]
    double small_ppm, large_ppm;  // Kopelevich particles of equivalent scattering
};

/// Names of all presets, clearest water first: jerlov-IB ... jerlov-5C.
std::vector<std::string> jerlov_preset_names();

/// The preset called `name`, case-insensitive. An unknown name: InputError listing them all.
const JerlovPreset& jerlov_preset(std::string_view name);

/// Absorption of the water type, without separate absorption by particles [1/m].
///
/// The measured points are too sparse for direct interpolation: pure water's absorption rises
/// tenfold from 555 to 630 nm. Therefore their excess over pure water, which is smooth, is
/// interpolated linearly, and pure water's absorption at `temperature` [deg C] and `salinity` [PSU]
/// is added. The excess is relative to pure water at 20 deg C and 35 PSU (a scene's defaults, and
/// close to the sampled seas), so that with these the sum equals the measured value at every
/// measured wavelength, and other values affect the water itself as they do without a preset.
/// Outside the measured range the excess at the end is used (0 if negative). Outside pure water's
/// table: InputError.
double jerlov_absorption(const JerlovPreset& preset, double wavelength_nm, double temperature,
                         double salinity);

/// Absorption per band of everything in the water except particles [1/m]: as given, or the preset's
/// (nullptr: pure water's) plus cdom and chlorophyll. Adds a line to `warnings` for each part that
/// does not cover the bands. Bands outside pure water's table: InputError.
Spectrum uniform_absorption(const WaterDesc& water, const JerlovPreset* preset,
                            std::vector<std::string>& warnings);

}  // namespace uw
