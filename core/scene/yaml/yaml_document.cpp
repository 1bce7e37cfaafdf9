#include "core/scene/yaml/yaml_document.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/base/utf8.h"

namespace uw {
namespace {

/// A node's contribution to YamlLimits::nodes; long texts count more, so that aliases of them do
/// too.
std::size_t weight(const ConfigNode& node) {
    std::size_t sum = 1 + node.scalar.size() / 256;
    for (const ConfigNode& item : node.items) sum += weight(item);
    for (const ConfigNode::Entry& entry : node.entries) {
        sum += entry.key.size() / 256 + weight(entry.value);
    }
    return sum;
}

/// The document being parsed, for messages.
struct Source {
    std::shared_ptr<const std::string> origin;
    bool has_lines = true;  // true for a file, false for the value of an override

    /// Line and column count from 0, as in the parser.
    ConfigPosition position(int line, int column) const {
        return has_lines ? ConfigPosition{origin, std::max(line, 0) + 1, std::max(column, 0) + 1}
                         : ConfigPosition{origin, 0, 0};
    }
    [[noreturn]] void fail(int line, int column, std::string_view what) const {
        throw InputError(fmt::format("{}: {}", position(line, column).text(), what));
    }
};

/// Builds the tree from the parser's events, so that a hostile document is rejected at its first
/// excess.
class TreeBuilder : public YAML::EventHandler {
  public:
    TreeBuilder(Source source, const YamlLimits& limits)
        : source_(std::move(source)), limits_(limits) {}

    std::optional<ConfigNode> take_root() { return std::move(root_); }

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (++documents_ > 1) {
            fail(mark,
                 fmt::format(
                     "a second document starts here; a {} is one document: remove this, or the "
                     "'---' above it",
                     limits_.subject));
        }
    }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        add(make(ConfigNode::Kind::null, mark), anchor);
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        check_tag(mark, tag);
        ConfigNode node = make(ConfigNode::Kind::scalar, mark);
        node.quoted = tag == "!";  // the parser's mark of non-plain scalars
        node.scalar = value;
        add(std::move(node), anchor);
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        const auto found = anchors_.find(anchor);
        if (found == anchors_.end())
            fail(mark, "an alias inside the value it refers to; write the value out");
        count(mark, weight(found->second));
        ConfigNode copy = found->second;
        copy.alias = source_.position(mark.line, mark.column);
        add(std::move(copy), YAML::NullAnchor);
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value /*style*/) override {
        open(ConfigNode::Kind::sequence, mark, tag, anchor);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value /*style*/) override {
        open(ConfigNode::Kind::map, mark, tag, anchor);
    }
    void OnMapEnd() override { close(); }

  private:
    struct Open {
        ConfigNode node;
        YAML::anchor_t anchor;
        std::optional<ConfigNode> key;  // map: a key whose value has not been parsed yet
    };

    [[noreturn]] void fail(const YAML::Mark& mark, std::string_view what) const {
        source_.fail(mark.line, mark.column, what);
    }
    void check_tag(const YAML::Mark& mark, const std::string& tag) const {
        if (tag.empty() || tag == "?" || tag == "!") return;
        fail(mark, fmt::format("the tag '{}' has no meaning in a {}; remove it", printable(tag),
                               limits_.subject));
    }
    void count(const YAML::Mark& mark, std::size_t nodes) {
        nodes_ += nodes;
        if (nodes_ <= limits_.nodes) return;
        fail(mark,
             fmt::format("more than {} values (aliases count each time); this is not a valid {}",
                         limits_.nodes, limits_.subject));
    }
    ConfigNode make(ConfigNode::Kind kind, const YAML::Mark& mark) {
        count(mark, 1);
        ConfigNode node;
        node.kind = kind;
        node.position = source_.position(mark.line, mark.column);
        return node;
    }
    void open(ConfigNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
              YAML::anchor_t anchor) {
        check_tag(mark, tag);
        if (open_.size() >= limits_.depth) {
            fail(mark, fmt::format("nested more than {} deep; this is not a valid {}",
                                   limits_.depth, limits_.subject));
        }
        open_.push_back({make(kind, mark), anchor, std::nullopt});
    }
    void close() {
        ConfigNode node = std::move(open_.back().node);
        const YAML::anchor_t anchor = open_.back().anchor;
        open_.pop_back();
        add(std::move(node), anchor);
    }
    void add(ConfigNode node, YAML::anchor_t anchor) {
        if (anchor != YAML::NullAnchor) {
            nodes_ += weight(node);
            if (nodes_ > limits_.nodes) {
                throw InputError(fmt::format(
                    "{}: more than {} values (anchors count twice); this is not a valid {}",
                    node.position.text(), limits_.nodes, limits_.subject));
            }
            anchors_.insert_or_assign(anchor, node);
        }
        if (open_.empty()) {
            root_ = std::move(node);
        } else if (open_.back().node.kind == ConfigNode::Kind::sequence) {
            open_.back().node.items.push_back(std::move(node));
        } else {
            add_to_map(open_.back(), std::move(node));
        }
    }
    static void add_to_map(Open& map, ConfigNode node) {
        if (!map.key) {
            if (node.kind != ConfigNode::Kind::scalar || node.scalar.empty()) {
                throw InputError(fmt::format("{}: a key must be a word, found {}; write key: value",
                                             node.position.text(), node.description()));
            }
            map.key = std::move(node);
            return;
        }
        ConfigNode::Entry entry;
        entry.key = std::move(map.key->scalar);
        entry.position = std::move(map.key->position);
        // the parser reports an empty value at the position of the next token
        if (node.kind == ConfigNode::Kind::null) node.position = entry.position;
        entry.value = std::move(node);
        map.key.reset();
        map.node.entries.push_back(std::move(entry));
    }

    Source source_;
    YamlLimits limits_;
    int documents_ = 0;
    std::size_t nodes_ = 0;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, ConfigNode> anchors_;
    std::optional<ConfigNode> root_;
};

/// Throws at the second of two equal keys.
void check_keys_unique(const ConfigNode& node, const std::string& path) {
    std::map<std::string_view, int> first_lines;
    for (const ConfigNode::Entry& entry : node.entries) {
        const std::string key_path = path + (path.empty() ? "" : ".") + printable(entry.key);
        const auto [first, is_new] = first_lines.emplace(entry.key, entry.position.line);
        if (!is_new) {
            throw InputError(
                fmt::format("{}: {}: the key is given twice (first on line {}); remove one",
                            entry.position.text(), key_path, first->second));
        }
        check_keys_unique(entry.value, key_path);
    }
    for (std::size_t i = 0; i < node.items.size(); ++i) {
        check_keys_unique(node.items[i], fmt::format("{}[{}]", path, i));
    }
}

/// Rejects text for which the parser would need gigabytes or minutes.
void check_text(std::string_view text, const Source& source, const YamlLimits& limits) {
    if (text.size() > limits.bytes) {
        source.fail(0, 0,
                    fmt::format("larger than {} bytes; this is not a valid {}", limits.bytes,
                                limits.subject));
    }
    const std::size_t bad = first_non_text(text);
    if (bad != text.size()) {
        const auto line = std::count(text.begin(), text.begin() + static_cast<long>(bad), '\n');
        source.fail(static_cast<int>(line), 0,
                    fmt::format("not UTF-8 text (byte {}); a {} is a YAML text file saved as "
                                "UTF-8",
                                bad, limits.subject));
    }
    constexpr std::string_view k_indicators = "[]{},:&*!\"'?";
    const auto indicators = std::count_if(text.begin(), text.end(), [&](char c) {
        return k_indicators.find(c) != std::string_view::npos;
    });
    if (static_cast<std::size_t>(indicators) > limits.indicators) {
        source.fail(
            0, 0,
            fmt::format("more than {} brackets, commas, colons and quotes; this is not a valid {}",
                        limits.indicators, limits.subject));
    }
}

/// The parser's own message, except where it is misleading.
std::string syntax_error(const YAML::Exception& error) {
    if (error.msg == YAML::ErrorMsg::DOC_IN_SCALAR || error.msg == YAML::ErrorMsg::EOF_IN_SCALAR) {
        return "text above this line has an opening quote but no closing one; close it";
    }
    return printable(error.msg, 200) + "; correct the YAML here or just above";
}

std::optional<ConfigNode> parse(std::string_view text, const Source& source,
                                const YamlLimits& limits) {
    check_text(text, source, limits);
    TreeBuilder builder(source, limits);
    // yaml-cpp 0.7 reads an unclosed quote as text up to the end of the file; an explicit end of
    // the document makes it an error
    std::istringstream stream{std::string(text) + "\n...\n"};
    try {
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& error) {
        source.fail(error.mark.line, error.mark.column, syntax_error(error));
    }
    std::optional<ConfigNode> root = builder.take_root();
    if (root) check_keys_unique(*root, "");
    return root;
}

}  // namespace

ConfigNode parse_yaml(std::string_view text, const std::string& origin, const YamlLimits& limits) {
    const Source source{std::make_shared<const std::string>(origin), true};
    std::optional<ConfigNode> root = parse(text, source, limits);
    if (!root || root->kind == ConfigNode::Kind::null) {
        source.fail(0, 0,
                    fmt::format("is empty; a {} is a YAML file with content, and a scene starts "
                                "with 'uwvdb: 1'",
                                limits.subject));
    }
    return *std::move(root);
}

ConfigNode parse_yaml_value(std::string_view text, const std::string& origin) {
    const Source source{std::make_shared<const std::string>(origin), false};
    std::optional<ConfigNode> root = parse(text, source, YamlLimits{});
    if (root) return *std::move(root);
    ConfigNode nothing;
    nothing.position = source.position(0, 0);
    return nothing;
}

}  // namespace uw
