#pragma once

#include "cli/command.h"

namespace uw {

/// `uwvdb edit`.
Command edit_command();

}  // namespace uw
