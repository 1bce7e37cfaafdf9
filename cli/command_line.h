#pragma once

#include <functional>
#include <span>

#include "cli/command.h"

namespace uw {

/// Reads the command line: the options of the chosen command go to their variables, and its `run`
/// is returned; or what prints the requested help or version. Throws UsageError of one line if it
/// is wrong, with the nearest right word. `commands` outlive the result.
std::function<ExitCode()> read_command_line(int argc, const char* const* argv,
                                            std::span<const Command> commands);

}  // namespace uw
