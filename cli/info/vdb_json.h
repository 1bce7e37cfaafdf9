#pragma once

#include <string>

#include "cli/info/vdb_report.h"

namespace uw {

/// A report as one JSON object (docs/command-line.md).
std::string vdb_json(const VdbReport& report);

}  // namespace uw
