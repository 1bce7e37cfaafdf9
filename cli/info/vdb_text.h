#pragma once

#include <string>

#include "cli/info/vdb_report.h"

namespace uw {

/// A report for people: grids, advice, and the block to paste.
std::string vdb_text(const VdbReport& report);

/// "none", "zip", "blosc, active values only" and so on.
std::string compression_of(const GridSummary& grid);
/// How many bits its numbers have in the file: "half", "float", "fp8" and so on.
std::string precision_of(const GridSummary& grid);

}  // namespace uw
