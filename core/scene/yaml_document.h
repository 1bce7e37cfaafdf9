#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
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
/// The hash of the text of another file, taken as it is.
std::string text_hash(std::string text);

/// Limits on a document's size: generous for any real scene, yet safe against hostile ones.
struct YamlLimits {
    std::size_t bytes = std::size_t{16} << 20U;
    std::size_t indicators = 1000000;  // brackets, commas, colons, quotes and the like
    std::size_t nodes = 200000;        // after aliases are expanded
    std::size_t depth = 64;
    /// Its name in messages.
    std::string_view subject = "scene";
    bool has_tags = false;  ///< tags are passed over; else they are refused
};

/// Parses one YAML (or JSON) document. `origin` names it in messages and in the nodes' positions.
/// Aliases are expanded; merge keys are not supported, and tags only where the limits say so.
/// Throws InputError "file:line:column: what; hint" for a document that is not YAML, not UTF-8
/// text, empty, or over the limits, for more than one document and for duplicate keys.
ConfigNode parse_yaml(std::string_view text, const std::string& origin,
                      const YamlLimits& limits = {});

/// Parses the value of an override: as parse_yaml, but empty text is null, and positions have no
/// lines.
ConfigNode parse_yaml_value(std::string_view text, const std::string& origin);

/// How numbers are written into a scene file. They are the shortest that read back as the same
/// number, after rounding to `decimals` digits behind the point if that is given.
struct NumberStyle {
    std::optional<int> decimals;
};

/// A number as a person writes it: 0.25, 12, 1e-9.
std::string number_text(double value, const NumberStyle& style = {});

/// "[1, 2.5, 3]": a list of numbers as the value of SceneText::set.
std::string numbers_text(std::span<const double> values, const NumberStyle& style = {});

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

/// The entries of a map by the ranks of their keys, those of one rank as they are written.
std::vector<const ConfigNode::Entry*> entries_by_rank(const ConfigNode& map);

/// A text in single quotes.
std::string in_yaml_quotes(std::string_view text);

}  // namespace uw
