#pragma once

#include <iosfwd>

#include "cli/command.h"
#include "cli/validate/validate_options.h"
#include "cli/validate/validation.h"

namespace uw {

/// `uwvdb validate`: prints a table per scene to `out`, in red where a check failed and `colour` is
/// set, and writes the requested report; reports progress on stderr. Returns whether all checks
/// passed. `volume` wraps the volume integrator if given: tests use it to show that the checks can
/// fail. Throws UsageError, InputError, IoError and Interrupted.
bool run_validate(const ValidateArguments& arguments, bool colour, std::ostream& out,
                  const TransportWrapper& volume = {});

/// `uwvdb validate` as the command line knows it.
Command validate_command();

}  // namespace uw
