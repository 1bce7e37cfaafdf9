#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "edit/document/yaml_source.h"

namespace uw {

/// A document while it is being changed: changes are made in its own style, comments stay, and an
/// anchor that is changed is handed on to the first of its aliases. What it has become is to be
/// compared with what was intended: rare layouts may defeat it.
class YamlDraft {
  public:
    /// `tree` is what `text` parses to.
    YamlDraft(std::string text, std::string origin, ConfigNode tree);

    const std::string& text() const { return source_.text(); }
    const ConfigNode& tree() const { return source_.tree(); }

    /// Changes, adds and removes values until the tree means the same as `target`.
    void become(const ConfigNode& target);
    /// Removes an entry of a map or an item of a list.
    void remove(const NodeRoute& route);
    /// Adds an item at the end of a list that has some, in the layout of its item `like`. If
    /// `is_copy`, the value is one of the document, and aliases in it stay aliases.
    void append(const NodeRoute& list, const ConfigNode& value, std::size_t like,
                bool is_copy = false);
    /// Adds the first item, a map, to a list at a key of a document without brackets: the key is
    /// missing, or has no value or an empty list.
    void start_list(std::string_view key, const ConfigNode& value);

  private:
    void replace(const NodeRoute& route, const ConfigNode& value);
    void add_entry(const NodeRoute& route, const std::string& key, const ConfigNode& value);

    YamlSource source_;
};

}  // namespace uw
