#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// The origin of part of a scene.
struct ConfigPosition {
    std::shared_ptr<const std::string> origin;  // file name, or "--set key=value"
    int line = 0;                               // from 1; 0: the origin has no lines
    int column = 0;                             // from 1, in bytes

    /// "plume.yaml:14:7", or the origin alone where there are no lines.
    std::string text() const;
};

/// Part of a scene file as inert data, with its position in the file. Scalars are still text: they
/// are interpreted when they are read (ConfigValue).
struct ConfigNode {
    enum class Kind : std::uint8_t { null, scalar, sequence, map };
    struct Entry;

    Kind kind = Kind::null;
    bool quoted = false;  // scalar: was quoted (or a text block), so it is text
    std::string scalar;
    std::vector<ConfigNode> items;  // sequence
    std::vector<Entry> entries;     // map, in the order of the file; no key twice
    ConfigPosition position;
    /// Where an alias stands for this value, which is written at `position`; line 0: nowhere.
    ConfigPosition alias;

    /// The value at `key` of a map; nullptr if there is none or this is not a map.
    const ConfigNode* find(std::string_view key) const;
    ConfigNode* find(std::string_view key);

    /// A description for messages: "a list of 3", "a map", "the text 'abc'", "the number 5".
    std::string description() const;
};

/// One key of a map with its value.
struct ConfigNode::Entry {
    std::string key;
    ConfigPosition position;  // of the key
    ConfigNode value;
};

/// 64-bit FNV-1a hash of the tree's meaning, as 16 hex digits: comments, layout, the order of keys
/// and the spelling of numbers (1, 1.0, 1e0) do not affect it.
std::string config_hash(const ConfigNode& root);
/// The same of the text of another file, which counts as it is.
std::string text_hash(std::string text);

}  // namespace uw
