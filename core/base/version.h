#pragma once

#include <string>

namespace uw {

/// Version as `uwvdb --version` prints it, e.g. "0.1.0+1a2b3c4".
std::string program_version();

}  // namespace uw
