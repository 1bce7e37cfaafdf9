#pragma once

#include "cli/command.h"

namespace uw {

/// `uwvdb info`: prints the contents of a VDB file or a scene, in metres, and what to fix, as text
/// or JSON. Throws UsageError, InputError and IoError of one line each.
Command info_command();

}  // namespace uw
