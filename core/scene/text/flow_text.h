#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "core/scene/yaml/config_node.h"

namespace uw {

/// How values are written on one line.
struct FlowStyle {
    bool is_json = false;  // keys and texts in double quotes
    /// The text of a value that was written as an alias; null: the value that it stands for.
    std::function<std::string(const ConfigNode& value)> alias_text{};
};

/// A text that YAML reads as one, with no more quotes than it needs, and safe within brackets.
std::string quoted_if_needed(std::string_view text, bool is_json = false);

/// A value on one line: 0.5, left, [1, 2], {type: spot, beam: 60}. Numbers are as they are spelled;
/// known keys are in the order in which scenes are usually written.
std::string flow_text(const ConfigNode& value, const FlowStyle& style = {});

/// The place of a key among those of a map: keys of lower rank come before it. Unknown ones come
/// last.
std::size_t key_rank(std::string_view key);

}  // namespace uw
