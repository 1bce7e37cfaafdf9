#pragma once

#include <string>

#include "cli/arguments.h"

namespace uw {

/// `uwvdb info`: what a VDB file or a scene holds, in metres, and what to mend, as text or JSON
/// for stdout. Throws UsageError, InputError and IoError of one line each.
std::string run_info(const InfoArguments& arguments);

}  // namespace uw
