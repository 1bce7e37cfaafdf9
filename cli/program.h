#pragma once

#include <vector>

#include "cli/command.h"

namespace uw {

/// The program: reads its command line as one of the commands that `add_commands` adds, runs it,
/// and returns the exit code. Whatever fails becomes one line on stderr.
int run_program(int argc, char** argv, void (*add_commands)(std::vector<Command>& commands));

}  // namespace uw
