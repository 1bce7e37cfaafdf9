#pragma once

#include <iosfwd>

#include "cli/calibration/calibration_options.h"
#include "cli/command.h"

namespace uw {

/// `uwvdb calibration`: what was understood of a calibration file, or of a scene's camera, as text
/// or JSON on `out`; with a format to write, that file's text instead, into a file or on `out`.
/// Warnings and names of files written go to stderr. Throws UsageError, InputError and IoError;
/// then no file has been touched, unless it is `out` that cannot be written.
void run_calibration(const CalibrationArguments& arguments, std::ostream& out);

/// `uwvdb calibration` as the command line knows it.
Command calibration_command();

}  // namespace uw
