#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/tables/sampled_curve.h"
#include "media/water/pure_water.h"

namespace uw {

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
/// Outside the measured range the excess at the end is held (0 if negative). Outside pure water's
/// table: InputError.
double jerlov_absorption(const JerlovPreset& preset, double wavelength_nm, double temperature,
                         double salinity);

}  // namespace uw
