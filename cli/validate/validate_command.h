#pragma once

#include <iosfwd>

#include "cli/command.h"
#include "cli/validate/validate_options.h"
#include "cli/validate/validation.h"

namespace uw {

/// `uwvdb validate`: prints a table per scene to `out`, red where a check failed and `colour`, and
/// writes the report asked for; says on stderr what it is at. Returns whether all checks passed.
/// `volume` wraps the volume integrator where it is given: a test that the checks can fail.
/// Throws UsageError, InputError, IoError and Interrupted.
bool run_validate(const ValidateArguments& arguments, bool colour, std::ostream& out,
                  const TransportWrapper& volume = {});

/// `uwvdb validate` as the command line knows it.
Command validate_command();

}  // namespace uw
