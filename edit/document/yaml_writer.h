#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/text/flow_text.h"
#include "core/scene/yaml/config_node.h"
#include "edit/document/yaml_layout.h"

namespace uw {

/// How new values are written.
struct WriteStyle {
    bool is_json = false;                 // keys and texts in double quotes
    const YamlLayout* aliases = nullptr;  // of a copied value: aliases in it stay aliases
};

/// A value on one line (core/scene/text/flow_text.h).
std::string flow_text(const ConfigNode& value, const WriteStyle& style);

/// The entries of a map, one below the other, in column `column`; the first line is not indented.
/// Values have the layout that `like`, a map, has at the same key; others are on one line.
/// `source` is the text of `like`, which may be null.
std::string block_text(const ConfigNode& map, const ConfigNode* like, const YamlLayout& source,
                       std::size_t column, std::string_view line_break, const WriteStyle& style);

}  // namespace uw
