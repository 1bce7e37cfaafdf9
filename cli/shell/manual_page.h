#pragma once

#include <span>
#include <string>

#include "cli/command.h"

namespace uw {

/// The manual page uwvdb(1) of all commands, in roff with the man macros.
std::string manual_page(std::span<const Command> commands);

}  // namespace uw
