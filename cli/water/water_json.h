#pragma once

#include <string>

#include "cli/water/water_report.h"

namespace uw {

/// Everything as one JSON object; undefined ratios are null.
std::string water_json(const WaterReport& report);

}  // namespace uw
