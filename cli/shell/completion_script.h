#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "cli/command.h"

namespace uw {

/// The shells that completions are written for.
inline constexpr std::array<std::string_view, 3> k_shells{"bash", "zsh", "fish"};

/// The script that completes the words of `uwvdb` in `shell`, one of k_shells: commands, options,
/// the words that some options take, and names of files elsewhere.
std::string completion_script(std::string_view shell, std::span<const Command> commands);

}  // namespace uw
