#pragma once

#include "cli/command.h"
#include "cli/points/points_options.h"

namespace uw {

/// `uwvdb rays`: the rays in the water of positions in a scene's image, as a table on standard
/// output or in a file. Counts go to stderr. Throws UsageError, InputError and IoError.
void run_rays(const PointsArguments& arguments);

/// `uwvdb rays` as the command line knows it.
Command rays_command();

}  // namespace uw
