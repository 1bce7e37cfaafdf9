#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace uw {

/// What the program's exit codes mean (docs/command-line.md).
enum ExitCode : int {
    k_exit_done = 0,
    k_exit_internal = 1,
    k_exit_usage = 2,
    k_exit_input = 3,
    k_exit_io = 4,
    k_exit_validation = 5,
    k_exit_interrupted = 130,
};

/// The same in words, for the manual page.
inline constexpr std::array<std::pair<ExitCode, std::string_view>, 7> k_exit_meanings{
    {{k_exit_done, "done"},
     {k_exit_internal, "internal fault"},
     {k_exit_usage, "wrong usage"},
     {k_exit_input, "bad input: a scene, volume, mesh or another file is wrong"},
     {k_exit_io, "a file cannot be read or written"},
     {k_exit_validation, "a validation failed"},
     {k_exit_interrupted, "interrupted"}}};

}  // namespace uw
