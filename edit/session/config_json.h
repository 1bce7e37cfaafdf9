#pragma once

#include "core/json/json.h"
#include "core/scene/yaml/config_node.h"

namespace uw {

/// Part of a scene file as JSON, with its scalars as YAML means them: numbers, true and false, or
/// text.
Json config_json(const ConfigNode& node);

}  // namespace uw
