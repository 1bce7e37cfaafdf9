#pragma once

#include <string>

namespace uw {

/// Version as `uwvdb --version` prints it, e.g. "1.0.0+1a2b3c4".
std::string program_version();

/// The libraries and the compiler that it was built with, e.g. "OpenVDB 10.0.1, Embree 3.13.5,
/// ...".
std::string build_libraries();

}  // namespace uw
