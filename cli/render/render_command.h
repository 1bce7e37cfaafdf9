#pragma once

#include "cli/command.h"

namespace uw {

/// `uwvdb render`: reads the scene, renders it and writes the EXR, its preview and whatever else
/// the arguments request, each file whole or not at all. Reports on stderr. Throws UsageError,
/// InputError and Interrupted, and then no file has been touched; IoError.
Command render_command();

}  // namespace uw
