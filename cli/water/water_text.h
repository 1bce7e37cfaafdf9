#pragma once

#include <string>

#include "cli/water/water_report.h"

namespace uw {

/// The tables for people, ASCII, with units and sources.
std::string water_text(const WaterReport& report);

}  // namespace uw
