#pragma once

#include <vector>

#include "cli/command.h"

namespace uw {

/// `uwvdb completion SHELL`: prints the script that completes `uwvdb` in a shell. `commands` are
/// all of the program's, including this one by the time it runs; they outlive the command.
Command completion_command(const std::vector<Command>& commands);

}  // namespace uw
