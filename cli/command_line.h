#pragma once

#include <functional>
#include <span>

#include "cli/command.h"

namespace uw {

/// Reads the command line: the options of the command that is named go to their variables, and its
/// `run` is returned; or what prints the help or version that is asked for. Throws UsageError of
/// one line for a wrong one, with the nearest right word. `commands` outlive the result.
std::function<ExitCode()> read_command_line(int argc, const char* const* argv,
                                            std::span<const Command> commands);

}  // namespace uw
