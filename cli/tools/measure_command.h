#pragma once

#include "cli/command.h"

namespace uw {

/// `uwvdb measure`: what light meters in a scene's water read.
Command measure_command();

}  // namespace uw
