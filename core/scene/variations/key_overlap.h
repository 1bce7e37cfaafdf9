#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/yaml/config_node.h"

namespace uw {

/// Whether the path `part` leads to the value at `whole` or into it, however each is written:
/// lamps.left.position[0] is part of lamps[0].position if that lamp is called left.
bool is_part_of(const ConfigNode& scene, const std::string& part, const std::string& whole);

/// Two of the paths of which one is part of the other; none if there are none.
std::optional<std::pair<std::string, std::string>> overlap(const ConfigNode& scene,
                                                           const std::vector<std::string>& keys);

}  // namespace uw
