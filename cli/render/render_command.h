#pragma once

#include "cli/arguments.h"

namespace uw {

/// `uwvdb render`: reads the scene, renders it and writes the EXR, its preview and what else the
/// arguments ask for, each file whole or not at all. Says what it does on stderr. Throws
/// UsageError, InputError and Interrupted, and then no file has been touched; IoError.
void run_render(const RenderArguments& arguments);

}  // namespace uw
