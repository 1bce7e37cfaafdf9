#pragma once

namespace uw {

/// What the program's exit code tells (docs/command-line.md).
enum ExitCode : int {
    k_exit_done = 0,
    k_exit_internal = 1,
    k_exit_usage = 2,
    k_exit_input = 3,
    k_exit_io = 4,
    k_exit_validation = 5,
    k_exit_interrupted = 130,
};

}  // namespace uw
