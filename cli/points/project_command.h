#pragma once

#include "cli/command.h"
#include "cli/points/points_options.h"

namespace uw {

/// `uwvdb project`: where a scene's camera sees points of the world, as a table on standard output
/// or in a file. Counts go to stderr. Throws UsageError, InputError and IoError.
void run_project(const PointsArguments& arguments);

/// `uwvdb project` as the command line knows it.
Command project_command();

}  // namespace uw
