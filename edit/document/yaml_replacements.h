#pragma once

#include <cstddef>
#include <vector>

#include "edit/document/yaml_source.h"

/// What to change in a document's text for a value of it to be replaced or removed.
namespace uw {

/// Another value at `route`, on one line. A text stays in its quotes, an anchor in its place.
std::vector<TextChange> replaced_value(const YamlSource& source, const NodeRoute& route,
                                       const ConfigNode& value);

/// The map or list at `parent` without one of its several entries. Comments around it stay.
std::vector<TextChange> removed_child(const YamlSource& source, const NodeRoute& parent,
                                      std::size_t child);

}  // namespace uw
