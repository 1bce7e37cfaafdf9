#pragma once

#include <string>

#include "cli/calibration/calibration_report.h"

namespace uw {

/// A report as one JSON object (docs/command-line.md).
std::string calibration_json(const CalibrationReport& report);

}  // namespace uw
