#pragma once

#include <iosfwd>

#include "cli/command.h"
#include "cli/water/water_options.h"

namespace uw {

/// `uwvdb water`: tables of a, b, c and beta of a preset's or a scene's water on `out`, as text or
/// JSON, and in the requested CSV and SVG files. Warnings and names of files written go to stderr.
/// Throws UsageError, InputError and IoError; then no file has been touched, unless it is `out`
/// that cannot be written.
void run_water(const WaterArguments& arguments, std::ostream& out);

/// `uwvdb water` as the command line knows it.
Command water_command();

}  // namespace uw
