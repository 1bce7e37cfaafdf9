#pragma once

#include "cli/command.h"

namespace uw {

/// `uwvdb fit`: numbers of a scene from what photographs show.
Command fit_command();

}  // namespace uw
