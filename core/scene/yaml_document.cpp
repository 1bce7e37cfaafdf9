#include "core/scene/yaml_document.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"

namespace uw {

namespace {

/// FNV-1a, 64 bit (Fowler, Noll, Vo; draft-eastlake-fnv).
class Fnv1a {
  public:
    void add(std::string_view bytes) {
        for (const char c : bytes) {
            state_ ^= static_cast<unsigned char>(c);
            state_ *= 0x100000001b3ULL;
        }
    }
    std::uint64_t value() const { return state_; }

  private:
    std::uint64_t state_ = 0xcbf29ce484222325ULL;
};

void add_text(Fnv1a& hash, char mark, std::string_view text) {
    hash.add(fmt::format("{}{}:", mark, text.size()));
    hash.add(text);
}

void add_node(Fnv1a& hash, const ConfigNode& node) {
    switch (node.kind) {
        case ConfigNode::Kind::null:
            hash.add("0");
            return;
        case ConfigNode::Kind::scalar: {
            double number = 0;
            if (!node.quoted && parse_number(node.scalar, number) == NumberText::number) {
                add_text(hash, 'n', fmt::format("{}", number));
            } else {
                add_text(hash, 't', node.scalar);
            }
            return;
        }
        case ConfigNode::Kind::sequence:
            hash.add(fmt::format("s{}:", node.items.size()));
            for (const ConfigNode& item : node.items) add_node(hash, item);
            return;
        case ConfigNode::Kind::map: {
            std::vector<const ConfigNode::Entry*> sorted;
            sorted.reserve(node.entries.size());
            for (const ConfigNode::Entry& entry : node.entries) sorted.push_back(&entry);
            std::sort(sorted.begin(), sorted.end(),
                      [](const auto* a, const auto* b) { return a->key < b->key; });
            hash.add(fmt::format("m{}:", sorted.size()));
            for (const ConfigNode::Entry* entry : sorted) {
                add_text(hash, 'k', entry->key);
                add_node(hash, entry->value);
            }
            return;
        }
    }
}

}  // namespace

std::string ConfigPosition::text() const {
    const std::string& name = *origin;
    return line > 0 ? fmt::format("{}:{}:{}", name, line, column) : name;
}

const ConfigNode* ConfigNode::find(std::string_view key) const {
    for (const Entry& entry : entries) {
        if (entry.key == key) return &entry.value;
    }
    return nullptr;
}

ConfigNode* ConfigNode::find(std::string_view key) {
    for (Entry& entry : entries) {
        if (entry.key == key) return &entry.value;
    }
    return nullptr;
}

std::string ConfigNode::description() const {
    switch (kind) {
        case Kind::null:
            return "nothing";
        case Kind::sequence:
            return fmt::format("a list of {}", items.size());
        case Kind::map:
            return "a map";
        case Kind::scalar:
            break;
    }
    double number = 0;
    if (quoted) return fmt::format("the quoted text '{}'", printable(scalar));
    if (parse_number(scalar, number) == NumberText::number) return "the number " + scalar;
    return fmt::format("the text '{}'", printable(scalar));
}

std::string config_hash(const ConfigNode& root) {
    Fnv1a hash;
    add_node(hash, root);
    return fmt::format("{:016x}", hash.value());
}

std::string text_hash(std::string text) {
    ConfigNode content;
    content.kind = ConfigNode::Kind::scalar;
    content.quoted = true;
    content.scalar = std::move(text);
    return config_hash(content);
}

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
    /// `text` must outlive it.
    TreeBuilder(std::string_view text, Source source, const YamlLimits& limits)
        : text_(text), source_(std::move(source)), limits_(limits) {}

    std::optional<ConfigNode> take_root() { return std::move(root_); }

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (++documents_ < 2) return;
        if (is_marked(mark.line))
            fail(mark, fmt::format("a second document starts here; a {} is one document: remove "
                                   "this, or the '---' above it",
                                   limits_.subject));
        fail(mark,
             fmt::format("what is above is complete, and this is no part of it; write a {} as "
                         "lines of 'key: value', and indent what continues a value",
                         limits_.subject));
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

    /// Whether a document is marked by "---" at a line, counted from 0, or among the blank ones and
    /// comments above it.
    bool is_marked(int line) const {
        bool result = false;
        std::string_view left = text_;
        for (int i = 0; i <= line && !left.empty(); ++i) {
            const std::string_view here = left.substr(0, left.find('\n'));
            left.remove_prefix(std::min(here.size() + 1, left.size()));
            const std::size_t first = here.find_first_not_of(" \t\r");
            if (here.starts_with("---"))
                result = true;
            else if (i < line && first != std::string_view::npos && here[first] != '#')
                result = false;
        }
        return result;
    }
    [[noreturn]] void fail(const YAML::Mark& mark, std::string_view what) const {
        source_.fail(mark.line, mark.column, what);
    }
    void check_tag(const YAML::Mark& mark, const std::string& tag) const {
        if (limits_.has_tags || tag.empty() || tag == "?" || tag == "!") return;
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

    std::string_view text_;
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
    const std::filesystem::path name = *source.origin;
    const std::size_t bad = first_non_text(text);
    // The text of a .gltf is JSON, so the parser would take it.
    if (source.has_lines &&
        (bad != text.size() || text.size() > limits.bytes || name.extension() == ".gltf"))
        if (const std::string other = other_format(text, name, limits.subject); !other.empty())
            throw InputError(fmt::format("{}: {}", *source.origin, other));
    if (text.size() > limits.bytes) {
        source.fail(0, 0,
                    fmt::format("larger than {} bytes; this is not a valid {}", limits.bytes,
                                limits.subject));
    }
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

/// Where a tab indents a line in block style, at `error_line` (from 0) or just above it: the parser
/// stumbles over what follows. Line and column count from 0.
std::optional<std::pair<int, int>> indenting_tab(std::string_view text, int error_line) {
    int depth = 0;  // of brackets, within which tabs are allowed
    std::optional<std::pair<int, int>> tab;
    for (int line = 0; line <= error_line && !text.empty(); ++line) {
        const std::string_view here = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(here.size() + 1, text.size()));
        const std::size_t indent = here.find_first_not_of(" \t");
        if (indent == std::string_view::npos || here[indent] == '#') continue;
        const std::size_t found = here.substr(0, indent).find('\t');
        if (found != std::string_view::npos && depth == 0 && line >= error_line - 1 && !tab)
            tab = {line, static_cast<int>(found)};
        for (const char c : here) {
            if (c == '[' || c == '{') ++depth;
            if (c == ']' || c == '}') depth = std::max(depth - 1, 0);
        }
    }
    return tab;
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
    TreeBuilder builder(text, source, limits);
    // yaml-cpp 0.7 reads an unclosed quote as text up to the end of the file; an explicit end of
    // the document makes it an error
    std::istringstream stream{std::string(text) + "\n...\n"};
    try {
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& error) {
        if (const auto tab = indenting_tab(text, error.mark.line))
            source.fail(tab->first, tab->second,
                        "a tab indents this line, but YAML takes none there; indent with spaces");
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
                                "with 'uwvdb: 2'",
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

namespace {

std::string fixed_text(double value) {
    std::array<char, 400> digits{};  // the smallest number has 343 of them
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed)
            .ptr;
    return {digits.data(), end};
}

}  // namespace

std::string number_text(double value, const NumberStyle& style) {
    if (style.decimals) {
        const std::string rounded = fmt::format("{:.{}f}", value, *style.decimals);
        if (double again = 0; parse_number(rounded, again) == NumberText::number) value = again;
    }
    if (value == 0) return "0";  // not -0
    const double size = std::abs(value);
    if (size >= 1e-6 && size < 1e15) return fixed_text(value);
    std::array<char, 40> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                   std::chars_format::scientific)
                         .ptr;
    std::string text(digits.data(), end);
    const std::size_t exponent = text.find('e') + 2;  // behind its sign
    text.erase(exponent,
               std::min(text.find_first_not_of('0', exponent), text.size() - 1) - exponent);
    return text;
}

std::string numbers_text(std::span<const double> values, const NumberStyle& style) {
    std::string text = "[";
    for (const double value : values)
        text += (text.size() > 1 ? ", " : "") + number_text(value, style);
    return text + "]";
}

namespace {

/// In the order of docs/scene-file.md.
constexpr auto k_key_order = std::to_array<std::string_view>(
    {"uwvdb",      "camera",     "cameras",     "rig",        "water",      "volumes",
     "geometry",   "lamps",      "render",      "name",       "type",       "model",
     "file",       "resolution", "calibration", "intrinsics", "distortion", "port",
     "pose",       "lens",       "bands",       "preset",     "salinity",   "temperature",
     "absorption", "cdom",       "chlorophyll", "particles",  "small",      "large",
     "scattering", "b",          "phase",       "position",   "direction",  "width",
     "height",     "radius",     "samples",     "look_at",    "up",         "profile",
     "beam",       "edge",       "falloff",     "fwhm",       "rotate",     "tilt",
     "spectrum",   "intensity",  "power",       "lumens",     "frame"});

bool is_word_of_yaml(std::string_view text) {
    constexpr auto k_words = std::to_array<std::string_view>(
        {"null", "~", "true", "false", "yes", "no", "on", "off", "y", "n"});
    return std::ranges::find(k_words, lower_case(text)) != k_words.end();
}

bool is_plain_character(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x80 || is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view("_-./+ ()%$#").find(c) != std::string::npos;
}

/// Whether `text` may stand without quotes, in and outside brackets.
bool is_plain(std::string_view text) {
    if (text.empty() || text.back() == ' ' || text.front() == ' ' || text.front() == '#' ||
        text.front() == '-' || text.front() == '%' || text.find(" #") != std::string_view::npos ||
        text == "..." || is_word_of_yaml(text))
        return false;
    double number = 0;
    return std::ranges::all_of(text, is_plain_character) &&
           parse_number(text, number) == NumberText::no_number;
}

std::string in_double_quotes(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        if (c == '\n')
            result += "\\n";
        else if (c == '\t')
            result += "\\t";
        else if (static_cast<unsigned char>(c) < 0x20)
            result += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
        else
            result += c;
    }
    return result + '"';
}

std::string scalar_text(const ConfigNode& node, const FlowStyle& style) {
    if (node.quoted) return quoted_if_needed(node.scalar, style.is_json);
    double number = 0;
    const bool is_number = parse_number(node.scalar, number) == NumberText::number;
    if (is_number || is_word_of_yaml(node.scalar)) return node.scalar;
    return quoted_if_needed(node.scalar, style.is_json);
}

}  // namespace

std::vector<const ConfigNode::Entry*> entries_by_rank(const ConfigNode& map) {
    std::vector<const ConfigNode::Entry*> entries;
    entries.reserve(map.entries.size());
    for (const ConfigNode::Entry& entry : map.entries) entries.push_back(&entry);
    std::ranges::stable_sort(entries, {}, [](const auto* entry) { return key_rank(entry->key); });
    return entries;
}

std::string in_yaml_quotes(std::string_view text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'') result += c;
        result += c;
    }
    return result + "'";
}

std::string quoted_if_needed(std::string_view text, bool is_json) {
    if (is_json) return in_double_quotes(text);
    if (is_plain(text)) return std::string(text);
    const bool has_control =
        std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    if (has_control) return in_double_quotes(text);
    return in_yaml_quotes(text);
}

std::string flow_text(const ConfigNode& value, const FlowStyle& style) {
    if (value.alias.line > 0 && style.alias_text) return style.alias_text(value);
    switch (value.kind) {
        case ConfigNode::Kind::null:
            return "null";
        case ConfigNode::Kind::scalar:
            return scalar_text(value, style);
        case ConfigNode::Kind::sequence: {
            std::string text = "[";
            for (const ConfigNode& item : value.items)
                text += (text.size() > 1 ? ", " : "") + flow_text(item, style);
            return text + "]";
        }
        case ConfigNode::Kind::map:
            break;
    }
    std::string text = "{";
    for (const ConfigNode::Entry* entry : entries_by_rank(value))
        text += (text.size() > 1 ? ", " : "") + quoted_if_needed(entry->key, style.is_json) + ": " +
                flow_text(entry->value, style);
    return text + "}";
}

std::size_t key_rank(std::string_view key) {
    return static_cast<std::size_t>(
        std::distance(k_key_order.begin(), std::ranges::find(k_key_order, key)));
}

}  // namespace uw
