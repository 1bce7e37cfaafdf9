#pragma once

namespace uw {

/// Scattering coefficient of Kopelevich's small particles [1/m per ppm by volume]:
/// 1.34 (550/lambda)^1.7 (physics section 1).
double kopelevich_small_scattering(double wavelength_nm);

/// Scattering coefficient of Kopelevich's large particles [1/m per ppm by volume]:
/// 0.312 (550/lambda)^0.3.
double kopelevich_large_scattering(double wavelength_nm);

/// Density of small (mineral) and large (organic) particles [g/cm^3], which is also the mass of
/// one ppm by volume [g/m^3].
inline constexpr double k_small_particle_density = 2;
inline constexpr double k_large_particle_density = 1;

/// Absorption of mineral sediment [m^2/g]: 0.041 exp(-0.0123 (lambda - 443)) (Babin et al. 2003).
/// Multiplied by a density above, it is in [1/m per ppm].
double mineral_mass_absorption(double wavelength_nm);

}  // namespace uw
