#pragma once

#include "cli/command.h"

namespace uw {

/// `uwvdb record`: what the sensors of a scene's vehicle record, and how it moves.
Command record_command();

}  // namespace uw
