#pragma once

#include "cli/command.h"

namespace uw {

/// `uwvdb import rgbd`: scenes from pictures with depth.
Command import_command();

}  // namespace uw
