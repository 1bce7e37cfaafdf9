#include "edit/document/yaml_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "core/base/text.h"

namespace uw {
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
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return std::ranges::find(k_words, lower) != k_words.end();
}

bool is_plain_character(char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte >= 0x80 || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
           (c >= 'A' && c <= 'Z') || std::string_view("_-./+ ()%$#").find(c) != std::string::npos;
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

std::string scalar_text(const ConfigNode& node, const WriteStyle& style) {
    if (node.quoted) return quoted_if_needed(node.scalar, style.is_json);
    double number = 0;
    const bool is_number = parse_number(node.scalar, number) == NumberText::number;
    if (is_number || is_word_of_yaml(node.scalar)) return node.scalar;
    return quoted_if_needed(node.scalar, style.is_json);
}

std::string key_text(std::string_view key, const WriteStyle& style) {
    return style.is_json ? in_double_quotes(key) : quoted_if_needed(key);
}

/// In the order of `like` as far as it has them, then by rank.
std::vector<const ConfigNode::Entry*> in_order(const ConfigNode& map, const ConfigNode* like) {
    const auto place = [like](const ConfigNode::Entry* entry) {
        const std::size_t rank = key_rank(entry->key);
        if (like == nullptr) return rank;
        // Next to the nearest key of lower rank that is there.
        std::size_t best = 0;
        for (std::size_t i = 0; i < like->entries.size(); ++i) {
            if (like->entries[i].key == entry->key) return 2 * i + 1;
            if (key_rank(like->entries[i].key) <= rank) best = 2 * i + 2;
        }
        return best;
    };
    std::vector<const ConfigNode::Entry*> entries;
    entries.reserve(map.entries.size());
    for (const ConfigNode::Entry& entry : map.entries) entries.push_back(&entry);
    std::ranges::stable_sort(entries, {}, [](const auto* entry) { return key_rank(entry->key); });
    std::ranges::stable_sort(entries, {}, place);
    return entries;
}

}  // namespace

std::string quoted_if_needed(std::string_view text, bool is_json) {
    if (is_json) return in_double_quotes(text);
    if (is_plain(text)) return std::string(text);
    const bool has_control =
        std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    if (has_control) return in_double_quotes(text);
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'') result += c;
        result += c;
    }
    return result + "'";
}

std::string flow_text(const ConfigNode& value, const WriteStyle& style) {
    if (value.alias.line > 0 && style.aliases != nullptr)
        return std::string(style.aliases->text().substr(style.aliases->item(value).begin,
                                                        style.aliases->item(value).size()));
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
    for (const ConfigNode::Entry* entry : in_order(value, nullptr))
        text += (text.size() > 1 ? ", " : "") + key_text(entry->key, style) + ": " +
                flow_text(entry->value, style);
    return text + "}";
}

std::string block_text(const ConfigNode& map, const ConfigNode* like, const YamlLayout& source,
                       std::size_t column, std::string_view line_break, const WriteStyle& style) {
    std::string text;
    const std::string new_line = std::string(line_break) + std::string(column, ' ');
    const ConfigNode* const model =
        like != nullptr && like->kind == ConfigNode::Kind::map ? like : nullptr;
    for (const ConfigNode::Entry* entry : in_order(map, model)) {
        if (!text.empty()) text += new_line;
        text += key_text(entry->key, style) + ":";
        const ConfigNode& value = entry->value;
        const ConfigNode* const same = model != nullptr ? model->find(entry->key) : nullptr;
        const bool is_alias = value.alias.line > 0 && style.aliases != nullptr;
        const bool is_block = same != nullptr && same->alias.line == 0 && !is_alias &&
                              same->kind == ConfigNode::Kind::map && !same->entries.empty() &&
                              value.kind == ConfigNode::Kind::map && !value.entries.empty() &&
                              !source.is_flow(source.item(*same));
        if (!is_block) {
            text += " " + flow_text(value, style);
            continue;
        }
        const std::size_t own = source.column(source.offset(model->entries.front().position));
        const std::size_t theirs = source.column(source.offset(same->entries.front().position));
        const std::size_t inner = column + (theirs > own ? theirs - own : 2);
        text += std::string(line_break) + std::string(inner, ' ') +
                block_text(value, same, source, inner, line_break, style);
    }
    return text;
}

std::size_t key_rank(std::string_view key) {
    return static_cast<std::size_t>(
        std::distance(k_key_order.begin(), std::ranges::find(k_key_order, key)));
}

}  // namespace uw
