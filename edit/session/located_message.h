#pragma once

#include <string>

#include "core/json/json.h"

namespace uw {

/// A message about a scene file as {"message", "line", "column"}, the last two null where it does
/// not say "scene.yaml:14:7: ...".
Json located_message(const std::string& message, const std::string& file_name);

}  // namespace uw
