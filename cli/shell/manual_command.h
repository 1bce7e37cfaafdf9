#pragma once

#include <vector>

#include "cli/command.h"

namespace uw {

/// `uwvdb man`: prints the manual page. `commands` as for completion_command.
Command manual_command(const std::vector<Command>& commands);

}  // namespace uw
