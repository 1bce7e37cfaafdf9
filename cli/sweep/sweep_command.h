#pragma once

#include "cli/command.h"
#include "cli/sweep/sweep_options.h"

namespace uw {

/// `uwvdb sweep`: renders a scene for a grid of values, measures the pictures, and writes a table
/// and a plot of them; reports on stderr. What was measured before Ctrl-C is written, too; then it
/// throws Interrupted. Throws UsageError, InputError and IoError; then no file has been touched.
void run_sweep(const SweepArguments& arguments);

/// `uwvdb sweep` as the command line knows it.
Command sweep_command();

}  // namespace uw
