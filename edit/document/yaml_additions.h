#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "edit/document/yaml_source.h"

/// What to insert into a document's text for a value to be added to it, in its own style.
namespace uw {

/// A key with its value, added to the map at `route`: behind the keys that usually come before it.
std::vector<TextChange> added_entry(const YamlSource& source, const NodeRoute& route,
                                    const std::string& key, const ConfigNode& value);

/// An item at the end of a list that has some, in the layout of its item `like`. `is_copy`: the
/// value is one of the document, and aliases in it stay aliases.
std::vector<TextChange> added_item(const YamlSource& source, const NodeRoute& list,
                                   const ConfigNode& value, std::size_t like, bool is_copy = false);

/// The first item, a map, of a list at a key of a document without brackets: the key is missing, or
/// has no value or an empty list.
std::vector<TextChange> started_list(const YamlSource& source, std::string_view key,
                                     const ConfigNode& value);

}  // namespace uw
