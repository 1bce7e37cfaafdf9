#pragma once

#include <string>

#include "cli/water/water_report.h"

namespace uw {

/// CSV (RFC 4180, preceded by one comment line with units and sources): one row per wavelength.
/// Undefined ratios (0/0) are blank.
std::string water_coefficients_csv(const WaterReport& report);
/// CSV: one row per wavelength and angle, total first, then each component, then per unit of each
/// constituent.
std::string water_vsf_csv(const WaterReport& report);

}  // namespace uw
