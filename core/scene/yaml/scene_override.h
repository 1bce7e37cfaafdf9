#pragma once

#include <string>

#include "core/scene/yaml/config_node.h"

namespace uw {

/// Applies one "key.path=value" of --set to a scene's tree: `lamps[0].intensity=[1, 2, 3]`,
/// `lamps.left.power=20` (a list's entry by its name), `camera.pose.position=[0, 0, 1]`. The value
/// is YAML and replaces any existing one; missing maps along the path are created, so that a
/// mistyped key is caught by the same checks as in the file. Throws UsageError if `text` is not of
/// that form, InputError if the path does not exist.
void apply_override(ConfigNode& root, const std::string& text);

}  // namespace uw
