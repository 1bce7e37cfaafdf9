#pragma once

#include "cli/command.h"

namespace uw {

/// `uwvdb coefficients`: the coefficients of computer vision's formula for a scene.
Command coefficients_command();

}  // namespace uw
