#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "edit/document/yaml_source.h"

namespace uw {

/// Hands on the anchors of all values on the way to `route`, and of all below it if
/// `with_all_below`, that aliases elsewhere stand for: the first alias becomes the anchor, with the
/// value as it is now. A change there then changes nothing else. The document means the same.
void release_anchors(YamlSource& source, const NodeRoute& route, bool with_all_below);

/// What to change in a document's text for a value of it to be replaced or removed.

/// Another value at `route`, on one line. A text stays in its quotes, an anchor in its place.
std::vector<TextChange> replaced_value(const YamlSource& source, const NodeRoute& route,
                                       const ConfigNode& value);

/// The map or list at `parent` without one of its several entries. Comments around it stay.
std::vector<TextChange> removed_child(const YamlSource& source, const NodeRoute& parent,
                                      std::size_t child);

/// What to insert into a document's text for a value to be added to it, in its own style.

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

/// A document while it is being changed. What it has become is to be compared with what was
/// intended: rare layouts may defeat it.
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
    /// Adds an item to a list (added_item).
    void append(const NodeRoute& list, const ConfigNode& value, std::size_t like,
                bool is_copy = false);
    /// Makes the first item of a list (started_list).
    void start_list(std::string_view key, const ConfigNode& value);

  private:
    void replace(const NodeRoute& route, const ConfigNode& value);
    void add_entry(const NodeRoute& route, const std::string& key, const ConfigNode& value);

    YamlSource source_;
};

}  // namespace uw
