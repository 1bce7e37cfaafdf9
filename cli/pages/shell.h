#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.h"

namespace uw {

/// `text` in single quotes, for a POSIX shell.
std::string in_shell_quotes(const std::string& text);

/// The shells that completions are written for.
inline constexpr std::array<std::string_view, 3> k_shells{"bash", "zsh", "fish"};

/// The script that completes the words of `uwvdb` in `shell`, one of k_shells: commands, options,
/// the words that some options take, and names of files elsewhere.
std::string completion_script(std::string_view shell, std::span<const Command> commands);

/// `uwvdb completion SHELL`: prints the script that completes `uwvdb` in a shell. `commands` are
/// all of the program's, including this one by the time it runs; they outlive the command.
Command completion_command(const std::vector<Command>& commands);

/// The manual page uwvdb(1) of all commands, in roff with the man macros.
std::string manual_page(std::span<const Command> commands);

/// `uwvdb man`: prints the manual page. `commands` as for completion_command.
Command manual_command(const std::vector<Command>& commands);

}  // namespace uw
