#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "core/scene/yaml/config_node.h"

namespace uw {

/// Limits on a document's size: generous for any real scene, yet safe against hostile ones.
struct YamlLimits {
    std::size_t bytes = std::size_t{16} << 20U;
    std::size_t indicators = 1000000;  // brackets, commas, colons, quotes and the like
    std::size_t nodes = 200000;        // after aliases are expanded
    std::size_t depth = 64;
    /// Its name in messages.
    std::string_view subject = "scene";
};

/// Parses one YAML (or JSON) document. `origin` names it in messages and in the nodes' positions.
/// Aliases are expanded; tags and merge keys are not supported. Throws InputError
/// "file:line:column: what; mend" for a document that is not YAML, not UTF-8 text, empty, or over
/// the limits, for more than one document and for duplicate keys.
ConfigNode parse_yaml(std::string_view text, const std::string& origin,
                      const YamlLimits& limits = {});

/// Parses the value of an override: as parse_yaml, but empty text is null, and positions have no
/// lines.
ConfigNode parse_yaml_value(std::string_view text, const std::string& origin);

}  // namespace uw
