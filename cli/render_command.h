#pragma once

#include "cli/arguments.h"

namespace uw {

/// `uwvdb render`: reads the scene, renders it and writes the EXR, its preview and what else the
/// arguments ask for. Says what it does on stderr. Throws UsageError, InputError, IoError and
/// Interrupted; then no output file has been touched.
void run_render(const RenderArguments& arguments);

}  // namespace uw
