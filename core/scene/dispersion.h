#pragma once

#include <optional>
#include <string>

#include "core/scene/config_value.h"

namespace uw {

/// A refractive index that depends on the wavelength, against air of a laboratory, as tables of
/// glasses and of water give it: with these, air itself is 1.
struct DispersionDesc {
    enum class Material {
        vacuum,         ///< Ciddor 1996: the reciprocal of dry air's at 15 deg C and 101325 Pa
        bk7,            ///< Schott N-BK7, data sheet
        fused_silica,   ///< Malitson 1965
        sapphire,       ///< Dodge 1986 (Malitson and Dodge 1972), ordinary ray
        pmma,           ///< Sultanova, Kasarova and Nikolov 2009
        polycarbonate,  ///< Sultanova, Kasarova and Nikolov 2009
        water,          ///< Quan and Fry 1995, by salinity and temperature
        abbe,           ///< Cauchy's n = A + B / lambda^2, by n_d and Abbe's number
    };
    Material material = Material::bk7;
    std::optional<double> salinity{};     ///< of water [PSU]; none: that of the scene's
    std::optional<double> temperature{};  ///< of water [degrees Celsius]; likewise
    double n_d = 1, abbe = 1;             ///< abbe: at 587.56 nm, and (n_d - 1) / (n_F - n_C)

    friend bool operator==(const DispersionDesc&, const DispersionDesc&) = default;
};

/// The range of wavelengths at which the materials' indices are accurate enough for rays [nm]:
/// somewhat wider than that of their measurements.
inline constexpr double k_shortest_dispersion_nm = 300, k_longest_dispersion_nm = 1100;

/// The index at a wavelength. Precondition: water has its salinity and temperature.
double refractive_index(const DispersionDesc& desc, double wavelength_nm);

/// Refractive index of (sea) water against air at `temperature` [deg C] and `salinity` [PSU]:
/// Quan and Fry 1995, eq. 3, for 0 to 30 deg C, 0 to 35 PSU and 400 to 700 nm, and beyond (Huibers
/// 1997: 200 to 1100 nm).
double water_refractive_index(double wavelength_nm, double temperature, double salinity);

/// Reads a refractive index: a number, which is stored in `number`, or a material by its name, as
/// {salinity, temperature} or {n_d, abbe}. None for a number, and for air, which is 1.
std::optional<DispersionDesc> read_index(const ConfigValue& value, double& number);
/// A material as a scene file has it.
std::string scene_text(const DispersionDesc& desc);

}  // namespace uw
