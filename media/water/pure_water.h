#pragma once

namespace uw {

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

}  // namespace uw
