#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/yaml/config_node.h"
#include "edit/document/yaml_layout.h"
#include "edit/document/yaml_writer.h"

namespace uw {

/// The way to a node: the index of the entry or item in each node from the root on.
using NodeRoute = std::vector<std::size_t>;

/// The entry or item of a map or list.
const ConfigNode& child_of(const ConfigNode& node, std::size_t index);
const ConfigNode& node_at(const ConfigNode& root, const NodeRoute& route);

/// Whether two values mean the same: comments, layout, the order of keys and the spelling of
/// numbers do not matter.
bool means_the_same(const ConfigNode& a, const ConfigNode& b);

/// `length` bytes at `offset` that give way to `text`.
struct TextChange {
    std::size_t offset = 0, length = 0;
    std::string text;
};

/// A document's text with the tree that it parses to, and where its nodes lie in it.
class YamlSource {
  public:
    /// `tree` is what `text` parses to.
    YamlSource(std::string text, std::string origin, ConfigNode tree);
    YamlSource(const YamlSource&) = delete;
    YamlSource& operator=(const YamlSource&) = delete;
    YamlSource(YamlSource&&) = delete;
    YamlSource& operator=(YamlSource&&) = delete;
    ~YamlSource() = default;

    const std::string& text() const { return text_; }
    const ConfigNode& tree() const { return tree_; }
    const YamlLayout& layout() const { return layout_; }

    /// Changes that do not overlap. Throws InputError as parse_yaml.
    void apply(std::vector<TextChange> changes);

    const ConfigNode& node(const NodeRoute& route) const { return node_at(tree_, route); }
    /// The entry of a map that a route leads to; nullptr if it leads to a list's item or the root.
    const ConfigNode::Entry* entry(const NodeRoute& route) const;
    /// Of the value or item, as YamlLayout; of the root the rest of the text.
    TextSpan span(const NodeRoute& route) const;
    /// Whether a map or list is written with brackets.
    bool is_flow(const NodeRoute& route) const;
    /// The lines that a span lies on, with one of the line breaks around them.
    TextSpan whole_lines(TextSpan span) const;
    /// How values are written there: as JSON within a map whose keys are all in double quotes.
    WriteStyle style(const NodeRoute& route) const;

  private:
    std::string text_;
    std::string origin_;
    ConfigNode tree_;
    YamlLayout layout_;
};

}  // namespace uw
