#pragma once

#include <string>

namespace uw {

/// Where an entry stands in the scene file, for messages: "plume.yaml:14:7: volumes[0].file". For
/// what no file holds, its path of keys alone, or empty.
using SourceLocation = std::string;

}  // namespace uw
