#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/yaml_document.h"

namespace uw {

/// The bytes [begin, end) of a text.
struct TextSpan {
    std::size_t begin = 0, end = 0;

    std::size_t size() const { return end - begin; }
    bool contains(std::size_t offset) const { return offset >= begin && offset < end; }
};

/// The positions of the parts of a parsed document in its text. Beginnings are the parser's
/// positions; ends are found by reading on from there along the tree. Throws InputError for what is
/// laid out in rare ways (keys after '?', entries without a value and the like). Refers to the
/// text.
class YamlLayout {
  public:
    explicit YamlLayout(std::string_view text);

    /// The offset of a position of the parser. Precondition: the position has a line.
    std::size_t offset(const ConfigPosition& position) const;

    /// An entry of a map, from its key to the end of its value.
    TextSpan entry(const ConfigNode::Entry& entry) const;
    /// The key alone.
    TextSpan key(const ConfigNode::Entry& entry) const;
    /// The end of a key's colon.
    std::size_t after_colon(const ConfigNode::Entry& entry) const;
    /// The value of an entry or the item of a list, with its anchor or as an alias. An empty value
    /// is an empty span behind the colon.
    TextSpan value(const ConfigNode::Entry& entry) const;
    TextSpan item(const ConfigNode& item) const;
    /// The dash of the item of a block list.
    std::size_t dash(const ConfigNode& item) const;

    /// Whether a map or list that is no alias is written with brackets; `span` is its span as
    /// above.
    bool is_flow(TextSpan span) const;
    /// The span without the anchor that it may begin with.
    TextSpan without_anchor(TextSpan span) const;
    /// The anchor with its '&', or empty.
    std::string_view anchor(TextSpan span) const;

    /// The first byte of the line of `offset`, and its end without its line break.
    std::size_t line_begin(std::size_t offset) const;
    std::size_t line_end(std::size_t offset) const;
    /// The first byte of the next line, or the end of the text.
    std::size_t next_line(std::size_t offset) const;
    /// Bytes from the beginning of its line.
    std::size_t column(std::size_t offset) const { return offset - line_begin(offset); }
    /// The first byte from `offset` on that is neither white space nor part of a comment.
    std::size_t skip_blanks(std::size_t offset) const;
    /// The line break that the text uses about `offset`.
    std::string_view line_break(std::size_t offset) const;

    std::string_view text() const { return text_; }
    /// Throws the InputError that this place cannot be edited.
    [[noreturn]] void fail(const ConfigPosition& position) const;

  private:
    TextSpan value_from(const ConfigNode& node, std::size_t begin, std::size_t indent) const;
    std::size_t end_of_scalar(const ConfigNode& node, std::size_t begin, std::size_t indent) const;
    std::size_t end_of_plain(const ConfigNode& node, std::size_t begin) const;
    std::size_t end_of_quoted(std::size_t begin) const;
    std::size_t end_of_text_block(std::size_t begin, std::size_t indent) const;
    std::size_t end_of_collection(const ConfigNode& node, std::size_t begin) const;
    char at(std::size_t offset) const { return offset < text_.size() ? text_[offset] : '\0'; }

    std::string_view text_;
    std::vector<std::size_t> lines_;  // where each begins
};

/// How new values are written.
struct WriteStyle {
    bool is_json = false;                 // keys and texts in double quotes
    const YamlLayout* aliases = nullptr;  // if it is set, aliases in a copied value stay aliases
};

/// A value on one line (core/scene/yaml_document.h).
std::string flow_text(const ConfigNode& value, const WriteStyle& style);

/// The entries of a map, one below the other, in column `column`; the first line is not indented.
/// Values have the layout that `like`, a map, has at the same key; others are on one line.
/// `source` is the text of `like`, which may be null.
std::string block_text(const ConfigNode& map, const ConfigNode* like, const YamlLayout& source,
                       std::size_t column, std::string_view line_break, const WriteStyle& style);

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

    /// Makes changes that do not overlap. Throws InputError as parse_yaml.
    void apply(std::vector<TextChange> changes);

    const ConfigNode& node(const NodeRoute& route) const { return node_at(tree_, route); }
    /// The entry of a map that a route leads to; nullptr if it leads to a list's item or the root.
    const ConfigNode::Entry* entry(const NodeRoute& route) const;
    /// The span of the value or item, by YamlLayout; the root has the rest of the text.
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
