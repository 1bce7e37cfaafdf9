#pragma once

#include <string>

#include "cli/command.h"
#include "cli/info/info_options.h"

namespace uw {

/// `uwvdb info`: what a VDB file or a scene holds, in metres, and what to fix, as text or JSON for
/// stdout. Throws UsageError, InputError and IoError of one line each.
std::string run_info(const InfoArguments& arguments);

/// `uwvdb info` as the command line knows it.
Command info_command();

}  // namespace uw
