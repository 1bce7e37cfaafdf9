#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/tables/sampled_curve.h"
#include "media/water/pure_water.h"

namespace uw {

/// A Jerlov water type with measured inherent optical properties (Williamson and Hollins 2022).
struct JerlovPreset {
    std::string name;                // "jerlov-II"
    WavelengthRange measured;        // where its absorption was measured
    SampledCurve excess_absorption;  // measured - pure water's, at the measured wavelengths [1/m]
    double small_ppm, large_ppm;     // Kopelevich particles that scatter like it
};

/// Names of all presets, clearest water first: jerlov-IB ... jerlov-5C.
std::vector<std::string> jerlov_preset_names();

/// The preset called `name`, upper or lower case. An unknown name: InputError listing them all.
const JerlovPreset& jerlov_preset(std::string_view name);

/// Absorption of the water type without particles' own [1/m].
///
/// The measured points lie too far apart to join up: pure water rises tenfold from 555 to 630 nm.
/// So what they exceed pure water by, which is smooth, is interpolated linearly, and pure water's
/// absorption at `temperature` [deg C] and `salinity` [PSU] added. The excess is over pure water
/// at 20 deg C and 35 PSU (a scene's defaults, and near the sampled seas), so that with those the
/// sum is the measured value at every measured wavelength, and other values change the water
/// itself as they do without a preset. Outside the measured range the end's excess holds (0 where
/// it is negative). Outside pure water's table: InputError.
double jerlov_absorption(const JerlovPreset& preset, double wavelength_nm, double temperature,
                         double salinity);

}  // namespace uw
