#pragma once

#include <iosfwd>

#include "cli/arguments.h"
#include "cli/validate/validation.h"

namespace uw {

/// `uwvdb validate`: prints a table per scene to `out`, red where a check failed and `colour`, and
/// writes the report asked for; says on stderr what it is at. Returns whether all checks passed.
/// `volume` replaces the volume integrator where it is given: a test that the checks can fail.
/// Throws UsageError, InputError, IoError and Interrupted.
bool run_validate(const ValidateArguments& arguments, bool colour, std::ostream& out,
                  const TransportFactory& volume = {});

}  // namespace uw
