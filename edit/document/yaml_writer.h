#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/yaml/config_node.h"
#include "edit/document/yaml_layout.h"

namespace uw {

/// How new values are written.
struct WriteStyle {
    bool is_json = false;                 // keys and texts in double quotes
    const YamlLayout* aliases = nullptr;  // of a copied value: aliases in it stay aliases
};

/// A text that YAML reads as one, with no more quotes than it needs, and safe within brackets.
std::string quoted_if_needed(std::string_view text, bool is_json = false);

/// A value on one line: 0.5, left, [1, 2], {type: spot, beam: 60}. Numbers are as they are spelled;
/// known keys are in the order in which scenes are usually written.
std::string flow_text(const ConfigNode& value, const WriteStyle& style);

/// The entries of a map, one below the other, in column `column`; the first line is not indented.
/// Values have the layout that `like`, a map, has at the same key; others are on one line.
/// `source` is the text of `like`, which may be null.
std::string block_text(const ConfigNode& map, const ConfigNode* like, const YamlLayout& source,
                       std::size_t column, std::string_view line_break, const WriteStyle& style);

/// The place of a key among those of a map: keys of lower rank come before it. Unknown ones come
/// last.
std::size_t key_rank(std::string_view key);

}  // namespace uw
