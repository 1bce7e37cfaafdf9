#pragma once

#include <string>

namespace uw {

/// The location of an entry in the scene file, for messages: "plume.yaml:14:7: volumes[0].file".
/// For an entry that is not in a file, its key path alone, or empty.
using SourceLocation = std::string;

}  // namespace uw
